/* tinygltf's geometry, nodes, cameras and lights to ours. Index ranges are known to be good. */
#include "scene/gltf_shim.h"

#include <algorithm>
#include <cmath>

namespace eclat {

using nlohmann::json;

void convert_images(const json &list, ec_gltf *gltf)
{
    gltf->images = make_array<ec_gltf_image>(list.size());
    for (const json &in : list) {
        ec_gltf_image &out = gltf->images[gltf->image_count++];
        out.name = copy_string(in.value("name", ""));
        out.view = in.value("bufferView", -1);
        if (in.contains("uri")) out.uri = copy_bytes(in["uri"]);
    }
}

void convert_views(const tinygltf::Model &model, size_t count, ec_gltf *gltf)
{
    gltf->views = make_array<ec_gltf_view>(count);
    for (size_t i = 0; i < count; i++) {
        const tinygltf::BufferView &in = model.bufferViews[i];
        gltf->views[gltf->view_count++] = {in.buffer, in.byteOffset, in.byteLength, uint32_t(in.byteStride)};
    }
}

void convert_accessors(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->accessors = make_array<ec_gltf_accessor>(model.accessors.size());
    for (const tinygltf::Accessor &in : model.accessors) {
        ec_gltf_accessor &out = gltf->accessors[gltf->accessor_count++];
        /* views beyond the file's own are the stand-in from pad_for_tinygltf */
        out.view = in.bufferView < int(gltf->view_count) ? in.bufferView : -1;
        out.offset = in.byteOffset;
        out.count = in.count;
        out.component_type = uint32_t(in.componentType);
        out.components = in.type == TINYGLTF_TYPE_SCALAR ? 1
                         : in.type <= TINYGLTF_TYPE_VEC4 ? uint32_t(in.type)
                                                         : 0;
        out.normalized = in.normalized;
        if (!in.sparse.isSparse) continue;
        out.sparse = {uint64_t(in.sparse.count), in.sparse.indices.bufferView, in.sparse.values.bufferView,
                      uint64_t(in.sparse.indices.byteOffset), uint64_t(in.sparse.values.byteOffset),
                      uint32_t(in.sparse.indices.componentType)};
    }
}

static int32_t find_attribute(const tinygltf::Primitive &primitive, const char *name)
{
    auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

void convert_meshes(const tinygltf::Model &model, ec_gltf *gltf, bool &morphs)
{
    gltf->meshes = make_array<ec_gltf_mesh>(model.meshes.size());
    for (const tinygltf::Mesh &in : model.meshes) {
        ec_gltf_mesh &out = gltf->meshes[gltf->mesh_count++];
        out.name = copy_string(in.name);
        out.primitives = make_array<ec_gltf_primitive>(in.primitives.size());
        for (const tinygltf::Primitive &p : in.primitives) {
            morphs = morphs || !p.targets.empty();
            ec_gltf_primitive &q = out.primitives[out.primitive_count++];
            q.mode = p.mode;
            q.material = p.material;
            q.indices = p.indices;
            q.position = find_attribute(p, "POSITION");
            q.normal = find_attribute(p, "NORMAL");
            q.tangent = find_attribute(p, "TANGENT");
            q.color = find_attribute(p, "COLOR_0");
            q.uv[0] = find_attribute(p, "TEXCOORD_0");
            q.uv[1] = find_attribute(p, "TEXCOORD_1");
        }
    }
}

/* Translation x rotation x scale, column major. A quaternion that is not unit is normalised; zero is no rotation. */
static void compose_local(double m[16], const tinygltf::Node &node)
{
    double q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, t[3] = {0, 0, 0};
    if (node.rotation.size() == 4) std::copy(node.rotation.begin(), node.rotation.end(), q);
    if (node.scale.size() == 3) std::copy(node.scale.begin(), node.scale.end(), s);
    if (node.translation.size() == 3) std::copy(node.translation.begin(), node.translation.end(), t);
    double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double x = 0, y = 0, z = 0, w = 1;
    if (length > 0) x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
                         2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                         2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) m[4 * column + row] = r[3 * column + row] * s[column];
        m[12 + column] = t[column];
    }
    m[15] = 1;
}

void convert_nodes(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->nodes = make_array<ec_gltf_node>(model.nodes.size());
    for (const tinygltf::Node &in : model.nodes) {
        ec_gltf_node &out = gltf->nodes[gltf->node_count++];
        out.name = copy_string(in.name);
        out.mesh = in.mesh;
        out.camera = in.camera;
        auto light = in.extensions.find("KHR_lights_punctual");
        out.light = light != in.extensions.end() ? light->second.Get("light").GetNumberAsInt() : -1;
        if (in.matrix.size() == 16) std::copy(in.matrix.begin(), in.matrix.end(), out.local);
        else compose_local(out.local, in);
        out.children = make_array<int32_t>(in.children.size());
        std::copy(in.children.begin(), in.children.end(), out.children);
        out.child_count = uint32_t(in.children.size());
    }
}

void set_roots(const tinygltf::Model &model, ec_gltf *gltf)
{
    std::vector<int> roots;
    if (!model.scenes.empty()) {
        roots = model.scenes[size_t(std::max(model.defaultScene, 0))].nodes;
    } else {
        std::vector<bool> has_parent(model.nodes.size());
        for (const tinygltf::Node &node : model.nodes)
            for (int child : node.children) has_parent[size_t(child)] = true;
        for (size_t i = 0; i < model.nodes.size(); i++)
            if (!has_parent[i]) roots.push_back(int(i));
    }
    gltf->roots = make_array<int32_t>(roots.size());
    std::copy(roots.begin(), roots.end(), gltf->roots);
    gltf->root_count = uint32_t(roots.size());
}

static const float widest_yfov = 3.0f; /* glTF only advises to stay below pi, where a picture has no plane */

void convert_cameras(const tinygltf::Model &model, ec_gltf *gltf, const ec_log *log)
{
    gltf->cameras = make_array<ec_camera>(model.cameras.size());
    for (const tinygltf::Camera &in : model.cameras) {
        ec_camera &out = gltf->cameras[gltf->camera_count++];
        out.type = in.type == "orthographic" ? EC_CAMERA_ORTHOGRAPHIC : EC_CAMERA_PERSPECTIVE;
        out.yfov = float(in.perspective.yfov);
        out.aspect = float(in.perspective.aspectRatio);
        out.xmag = float(std::fabs(in.orthographic.xmag));
        out.ymag = float(std::fabs(in.orthographic.ymag));
        out.name = copy_string(in.name);
        std::string where = "cameras[" + std::to_string(gltf->camera_count - 1) + "]";
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.yfov > 0))
            throw bad_file(where + ": yfov must be positive, not " + std::to_string(out.yfov));
        if (out.yfov > widest_yfov) {
            ec_warn(log, "%s: %s: yfov %g is taken as %g", gltf->path, where.c_str(), out.yfov, widest_yfov);
            out.yfov = widest_yfov;
        }
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.aspect >= 0))
            throw bad_file(where + ": aspectRatio must be positive, not " + std::to_string(out.aspect));
        if (out.type == EC_CAMERA_ORTHOGRAPHIC && !(out.xmag > 0 && out.ymag > 0))
            throw bad_file(where + ": xmag and ymag must not be zero");
    }
}

void convert_lights(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->lights = make_array<ec_light>(model.lights.size());
    for (const tinygltf::Light &in : model.lights) {
        ec_light &out = gltf->lights[gltf->light_count++];
        out.type = in.type == "spot" ? EC_LIGHT_SPOT : in.type == "point" ? EC_LIGHT_POINT : EC_LIGHT_DIRECTIONAL;
        for (size_t i = 0; i < 3; i++) {
            double value = (in.color.size() == 3 ? in.color[i] : 1.0) * in.intensity;
            out.intensity[i] = float(std::min(std::max(value, 0.0), double(EC_RADIANCE_MOST)));
        }
        out.range = float(std::max(in.range, 0.0));
        const double half_pi = 1.57079632679489662;
        double outer = std::min(std::max(in.spot.outerConeAngle, 0.0), half_pi);
        double inner = std::min(std::max(in.spot.innerConeAngle, 0.0), outer);
        out.cos_inner = float(std::cos(inner));
        out.cos_outer = float(std::cos(outer));
    }
}

} // namespace eclat
