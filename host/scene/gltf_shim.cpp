/* .gltf or .glb to ec_gltf. tinygltf maps checked JSON to structs; files, URIs, buffers and images it never sees: its
 * own handling of those trusts the file (it falls back to the working directory, for one). */
#include "scene/gltf_shim.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>

namespace eclat {

using nlohmann::json;

static const char *const supported_extensions[] = {
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_specular",
    "KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"};

static bool is_supported(const std::string &name)
{
    return std::find(std::begin(supported_extensions), std::end(supported_extensions), name) !=
           std::end(supported_extensions);
}

/* Before the document's shape is checked: in another version it is another one. */
static void check_version(const json &root)
{
    const json asset = root.value("asset", json());
    auto text = [&](const char *key) {
        return asset.is_object() && asset.contains(key) && asset[key].is_string() ? asset[key].get<std::string>() : "";
    };
    std::string version = text("version"), minimum = text("minVersion");
    if (!version.empty() && version.compare(0, 2, "2.") != 0)
        throw bad_file("glTF version " + version.substr(0, 20) + " is not supported; convert the file to glTF 2.0");
    if (!minimum.empty() && minimum != "2.0")
        throw bad_file("the file needs glTF " + minimum.substr(0, 20) + "; eclat reads glTF 2.0");
}

static std::set<std::string> string_set(const json &root, const char *key)
{
    std::set<std::string> names;
    for (const json &name : root.value(key, json::array()))
        if (name.is_string()) names.insert(name.get<std::string>());
    return names;
}

static std::string comma_list(const std::set<std::string> &names)
{
    std::string list;
    for (const std::string &name : names) list += (list.empty() ? "" : ", ") + name.substr(0, 100);
    return printable(list);
}

static char **copy_strings(const std::set<std::string> &names, uint32_t *count)
{
    char **list = make_array<char *>(names.size());
    for (const std::string &name : names) {
        list[*count] = copy_string(name.empty() ? "?" : name);
        ++*count;
    }
    return list;
}

static void check_extensions(const json &root, ec_gltf *gltf, const ec_log *log)
{
    std::set<std::string> used = string_set(root, "extensionsUsed"), needed = string_set(root, "extensionsRequired");
    std::set<std::string> ignored, missing;
    for (const std::string &name : used)
        if (!is_supported(name)) ignored.insert(name);
    for (const std::string &name : needed)
        if (!is_supported(name)) missing.insert(name);
    if (!missing.empty())
        throw bad_file("the file requires " + comma_list(missing) + ", which eclat does not support; export it without");
    if (!ignored.empty())
        ec_warn(log, "%s: not supported, what it describes is left out: %s", gltf->path, comma_list(ignored).c_str());
    gltf->quantized = used.count("KHR_mesh_quantization") || needed.count("KHR_mesh_quantization");
    gltf->extensions_used = copy_strings(used, &gltf->extension_count);
    gltf->extensions_ignored = copy_strings(ignored, &gltf->extension_ignored_count);
}

/* The members that hold files are taken out of the tree, so that tinygltf has nothing to open. */
static json take(json &root, const char *key)
{
    json taken = root.value(key, json::array());
    root.erase(key);
    return taken;
}

static void check_uris(const json &list, const char *key)
{
    ec_error err;
    for (size_t i = 0; i < list.size(); i++) {
        std::string where = std::string(key) + "[" + std::to_string(i) + "]";
        if (list[i].contains("uri") &&
            ec_gltf_uri_check(where.c_str(), list[i]["uri"].get_ref<const std::string &>().c_str(), &err) != EC_OK)
            throw bad_file(err.text);
    }
}

static void load_buffer(ec_gltf_buffer &out, const json &in, const std::string &where, const container &file,
                        const ec_gltf *gltf)
{
    out.length = in["byteLength"];
    uint64_t available;
    if (in.contains("uri")) {
        ec_error err;
        const std::string &uri = in["uri"].get_ref<const std::string &>();
        if (ec_gltf_uri_load(gltf->folder, where.c_str(), uri.c_str(), &out.owned, &available, &err) != EC_OK)
            throw bad_file(err.text);
        out.data = out.owned;
    } else if (&out == gltf->buffers && file.chunk) {
        out.data = file.chunk;
        available = file.chunk_length;
    } else {
        return; /* an error only once somebody reads it */
    }
    if (out.length > available)
        throw bad_file(where + " promises " + std::to_string(out.length) + " bytes but holds " +
                       std::to_string(available) + "; the file is damaged or truncated");
}

static void load_buffers(const json &list, const container &file, ec_gltf *gltf)
{
    gltf->buffers = make_array<ec_gltf_buffer>(list.size());
    for (size_t i = 0; i < list.size(); i++) {
        gltf->buffer_count++;
        load_buffer(gltf->buffers[i], list[i], "buffers[" + std::to_string(i) + "]", file, gltf);
    }
}

static void convert_images(const json &list, ec_gltf *gltf)
{
    gltf->images = make_array<ec_gltf_image>(list.size());
    for (const json &in : list) {
        ec_gltf_image &out = gltf->images[gltf->image_count++];
        out.name = copy_string(in.value("name", ""));
        out.view = in.value("bufferView", -1);
        if (in.contains("uri")) out.uri = copy_bytes(in["uri"]);
    }
}

static void convert_views(const tinygltf::Model &model, size_t count, ec_gltf *gltf)
{
    gltf->views = make_array<ec_gltf_view>(count);
    for (size_t i = 0; i < count; i++) {
        const tinygltf::BufferView &in = model.bufferViews[i];
        gltf->views[gltf->view_count++] = {in.buffer, in.byteOffset, in.byteLength, uint32_t(in.byteStride)};
    }
}

static void convert_accessors(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->accessors = make_array<ec_gltf_accessor>(model.accessors.size());
    for (const tinygltf::Accessor &in : model.accessors) {
        ec_gltf_accessor &out = gltf->accessors[gltf->accessor_count++];
        /* views beyond the file's own are the stand-in from add_stand_in_view */
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

static void convert_meshes(const tinygltf::Model &model, ec_gltf *gltf, bool &morphs)
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

static void convert_nodes(const tinygltf::Model &model, ec_gltf *gltf)
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

static void set_roots(const tinygltf::Model &model, ec_gltf *gltf)
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

static void convert_cameras(const tinygltf::Model &model, ec_gltf *gltf)
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
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.yfov > 0 && out.yfov < 3.14159f))
            throw bad_file(where + ": yfov must lie between 0 and pi, not " + std::to_string(out.yfov));
        if (out.type == EC_CAMERA_PERSPECTIVE && !(out.aspect >= 0))
            throw bad_file(where + ": aspectRatio must be positive, not " + std::to_string(out.aspect));
        if (out.type == EC_CAMERA_ORTHOGRAPHIC && !(out.xmag > 0 && out.ymag > 0))
            throw bad_file(where + ": xmag and ymag must not be zero");
    }
}

static void convert_lights(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->lights = make_array<ec_light>(model.lights.size());
    for (const tinygltf::Light &in : model.lights) {
        ec_light &out = gltf->lights[gltf->light_count++];
        out.type = in.type == "spot" ? EC_LIGHT_SPOT : in.type == "point" ? EC_LIGHT_POINT : EC_LIGHT_DIRECTIONAL;
        for (size_t i = 0; i < 3; i++) {
            double value = (in.color.size() == 3 ? in.color[i] : 1.0) * in.intensity;
            out.intensity[i] = float(std::min(std::max(value, 0.0), 1e30));
        }
        out.range = float(std::max(in.range, 0.0));
        const double half_pi = 1.57079632679489662;
        double outer = std::min(std::max(in.spot.outerConeAngle, 0.0), half_pi);
        double inner = std::min(std::max(in.spot.innerConeAngle, 0.0), outer);
        out.cos_inner = float(std::cos(inner));
        out.cos_outer = float(std::cos(outer));
    }
}

/* tinygltf refuses index accessors without a bufferView (all zeros or sparse), which glTF allows: they get one that
 * does not exist in the file. Spot lights need their cone, though all its members have defaults. */
static void pad_for_tinygltf(json &root)
{
    json &views = root["bufferViews"];
    if (views.is_null()) views = json::array();
    size_t stand_in = views.size();
    views.push_back({{"buffer", 0}, {"byteLength", 1}});
    if (root.contains("accessors"))
        for (json &accessor : root["accessors"])
            if (!accessor.contains("bufferView")) accessor["bufferView"] = stand_in;
    if (root.contains("extensions") && root["extensions"].contains("KHR_lights_punctual"))
        for (json &light : root["extensions"]["KHR_lights_punctual"]["lights"])
            if (!light.contains("spot")) light["spot"] = json::object();
}

static void parse_model(json &root, tinygltf::Model &model)
{
    pad_for_tinygltf(root);
    std::string text = root.dump(), error, warning;
    root = json();
    if (text.size() > 0x7fffffff) throw bad_file("the JSON part has more than 2 GiB");
    tinygltf::TinyGLTF reader;
    if (reader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "")) return;
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw bad_file("tinygltf: " + (error.empty() ? "cannot read the document" : error));
}

static void warn_of_rest_pose(const json &animations, const json &skins, bool morphs, ec_gltf *gltf, const ec_log *log)
{
    std::set<std::string> what;
    if (!animations.empty()) what.insert("animations");
    if (!skins.empty()) what.insert("skins");
    if (morphs) what.insert("morph targets");
    if (!what.empty())
        ec_warn(log, "%s: %s are not supported yet; the meshes are shown as stored", gltf->path,
                comma_list(what).c_str());
}

static void read_document(ec_gltf *gltf, uint64_t length, const ec_log *log)
{
    container file = parse_container(gltf->file, length);
    json &root = file.root;
    if (!file.chunk) { /* JSON text is done with: with embedded buffers it is as large as the scene */
        free(gltf->file);
        gltf->file = nullptr;
    }
    check_version(root);
    check_extensions(root, gltf, log);
    check_document(root, gltf->path, log);
    json animations = take(root, "animations"), skins = take(root, "skins");
    json images = take(root, "images"), buffers = take(root, "buffers");
    check_uris(buffers, "buffers");
    check_uris(images, "images");
    load_buffers(buffers, file, gltf);
    buffers = json();
    convert_images(images, gltf);
    images = json();
    size_t view_count = root.contains("bufferViews") ? root["bufferViews"].size() : 0;

    tinygltf::Model model;
    parse_model(root, model);
    bool morphs = false;
    convert_views(model, view_count, gltf);
    convert_accessors(model, gltf);
    convert_meshes(model, gltf, morphs);
    convert_nodes(model, gltf);
    set_roots(model, gltf);
    convert_cameras(model, gltf);
    convert_lights(model, gltf);
    convert_textures(model, gltf);
    convert_materials(model, gltf, log);
    warn_of_rest_pose(animations, skins, morphs, gltf, log);
}

} // namespace eclat

extern "C" ec_result ec_gltf_read(const char *path, ec_gltf **result, const ec_log *log, ec_error *err)
{
    using namespace eclat;
    *result = nullptr;
    std::unique_ptr<ec_gltf, void (*)(ec_gltf *)> gltf(static_cast<ec_gltf *>(calloc(1, sizeof(ec_gltf))), ec_gltf_free);
    if (!gltf) return ec_fail(err, "%s: out of memory", path);
    gltf->path = path;
    try {
        std::string name = path;
        size_t slash = name.find_last_of('/');
        gltf->folder = strdup(slash == std::string::npos ? "" : name.substr(0, slash + 1).c_str());
        if (!gltf->folder) throw std::bad_alloc();
        uint64_t length;
        ec_result loaded = ec_gltf_file_load(path, &gltf->file, &length, err);
        if (loaded != EC_OK) return loaded;
        read_document(gltf.get(), length, log);
    } catch (const std::bad_alloc &) {
        return ec_fail(err, "%s: out of memory", path);
    } catch (const std::exception &e) {
        return ec_fail(err, "%s: %.1600s", path, printable(e.what()).c_str());
    } catch (...) {
        return ec_fail(err, "%s: cannot be read", path);
    }
    ec_result checked = ec_gltf_check_views(gltf.get(), err);
    if (checked != EC_OK) return checked;
    *result = gltf.release();
    return EC_OK;
}
