/* Converts views, accessors, meshes, skins and nodes from the checked JSON tree; index ranges and types are already checked. */
#include "gltf/gltf_shim.h"

#include <algorithm>

namespace eclat {

using nlohmann::json;

const json &list_of(const json &object, const char *key)
{
    static const json empty = json::array();
    auto found = object.find(key);
    return found == object.end() ? empty : *found;
}

const json *find_extension(const json &object, const char *name)
{
    auto extensions = object.find("extensions");
    if (extensions == object.end()) return nullptr;
    auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

static ec_gltf_meshopt convert_meshopt(const json &in)
{
    std::string mode = in["mode"], filter = in.value("filter", "NONE");
    ec_gltf_meshopt out = {};
    out.mode = mode == "ATTRIBUTES" ? EC_MESHOPT_ATTRIBUTES : mode == "TRIANGLES" ? EC_MESHOPT_TRIANGLES : EC_MESHOPT_INDICES;
    out.filter = filter == "OCTAHEDRAL"    ? EC_MESHOPT_OCTAHEDRAL
                 : filter == "QUATERNION"  ? EC_MESHOPT_QUATERNION
                 : filter == "EXPONENTIAL" ? EC_MESHOPT_EXPONENTIAL
                 : filter == "COLOR"       ? EC_MESHOPT_COLOR
                                           : EC_MESHOPT_NO_FILTER;
    out.buffer = in["buffer"];
    out.offset = in.value("byteOffset", uint64_t(0));
    out.length = in["byteLength"];
    out.count = in["count"];
    out.stride = in["byteStride"];
    return out;
}

void convert_views(const json &list, ec_gltf *gltf)
{
    convert_list(list, gltf->views, gltf->view_count, [](const json &in, ec_gltf_view &out) {
        out.buffer = in["buffer"];
        out.offset = in.value("byteOffset", uint64_t(0));
        out.length = in["byteLength"];
        out.stride = in.value("byteStride", 0u);
        for (const char *name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
            if (const json *packed = find_extension(in, name)) out.packed = convert_meshopt(*packed);
    });
}

/* Returns the number of components of an element; 0: a matrix type that is never read. */
static uint32_t component_count(const std::string &type)
{
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : type == "MAT4" ? 16 : 0;
}

void convert_accessors(const json &list, ec_gltf *gltf)
{
    convert_list(list, gltf->accessors, gltf->accessor_count, [](const json &in, ec_gltf_accessor &out) {
        out.view = in.value("bufferView", -1);
        out.offset = in.value("byteOffset", uint64_t(0));
        out.count = in["count"];
        out.component_type = in["componentType"];
        out.components = component_count(in["type"]);
        out.normalized = in.value("normalized", false);
        if (!in.contains("sparse")) return;
        const json &sparse = in["sparse"], &indices = sparse["indices"], &values = sparse["values"];
        out.sparse = {sparse["count"], indices["bufferView"], values["bufferView"], indices.value("byteOffset", uint64_t(0)),
                      values.value("byteOffset", uint64_t(0)), indices["componentType"]};
    });
}

static ec_gltf_streams convert_streams(const json &attributes)
{
    static const char *const names[EC_STREAMS] = {"POSITION", "NORMAL", "TANGENT", "COLOR_0", "TEXCOORD_0", "TEXCOORD_1"};
    ec_gltf_streams streams;
    for (int i = 0; i < EC_STREAMS; i++) streams.of[i] = attributes.value(names[i], -1);
    return streams;
}

/* Collects JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ... */
static void convert_influences(const json &attributes, ec_gltf_primitive &out)
{
    auto name = [](const char *stem) { return [stem](uint32_t i) { return stem + std::to_string(i); }; };
    auto joints = name("JOINTS_"), weights = name("WEIGHTS_");
    uint32_t count = 0;
    while (attributes.contains(joints(count)) && attributes.contains(weights(count))) count++;
    out.joints = make_array<int32_t>(count);
    out.weights = make_array<int32_t>(count);
    for (; out.influence_sets < count; out.influence_sets++) {
        out.joints[out.influence_sets] = attributes[joints(out.influence_sets)];
        out.weights[out.influence_sets] = attributes[weights(out.influence_sets)];
    }
}

static void convert_draco(const json &in, ec_gltf_primitive &out)
{
    const json *draco = find_extension(in, "KHR_draco_mesh_compression");
    out.draco_view = draco ? (*draco)["bufferView"].get<int32_t>() : -1;
    if (!draco) return;
    const json &ids = (*draco)["attributes"];
    out.draco = make_array<ec_gltf_draco>(ids.size());
    for (auto &id : ids.items()) {
        if (!id.value().is_number_unsigned())
            throw bad_file("KHR_draco_mesh_compression.attributes." + id.key() + " must be a non-negative integer");
        if (in["attributes"].contains(id.key())) out.draco[out.draco_count++] = {in["attributes"][id.key()], id.value()};
    }
}

static void convert_primitive(const json &in, ec_gltf_primitive &out)
{
    out.mode = in.value("mode", int(EC_GLTF_TRIANGLES));
    out.material = in.value("material", -1);
    out.indices = in.value("indices", -1);
    out.streams = convert_streams(in["attributes"]);
    convert_influences(in["attributes"], out);
    convert_draco(in, out);
    convert_list(list_of(in, "targets"), out.targets, out.target_count,
                 [](const json &target, ec_gltf_streams &streams) { streams = convert_streams(target); });
}

template <typename T> static void copy_list(const json &list, T *&numbers, uint32_t &count)
{
    convert_list(list, numbers, count, [](const json &in, T &number) { number = in; });
}

void convert_meshes(const json &list, ec_gltf *gltf)
{
    convert_list(list, gltf->meshes, gltf->mesh_count, [](const json &in, ec_gltf_mesh &out) {
        out.name = copy_string(in.value("name", ""));
        copy_list(list_of(in, "weights"), out.weights, out.weight_count);
        convert_list(in["primitives"], out.primitives, out.primitive_count, convert_primitive);
    });
}

void convert_weights(const json &list, ec_gltf *gltf)
{
    for (size_t i = 0; i < list.size(); i++) {
        ec_gltf_mesh &out = gltf->meshes[i];
        free(out.weights);
        out.weights = nullptr;
        out.weight_count = 0;
        copy_list(list_of(list[i], "weights"), out.weights, out.weight_count);
    }
}

void convert_skins(const json &list, ec_gltf *gltf)
{
    convert_list(list, gltf->skins, gltf->skin_count, [](const json &in, ec_gltf_skin &out) {
        out.inverse_bind = in.value("inverseBindMatrices", -1);
        copy_list(in["joints"], out.joints, out.joint_count);
    });
}

double element(const json &object, const char *key, size_t i, double fallback)
{
    auto found = object.find(key);
    return found == object.end() ? fallback : (*found)[i].get<double>();
}

/* Computes translation x rotation x scale, column major. A quaternion that is not unit is normalised; zero is no rotation. */
static void compose_local(double m[16], const json &node)
{
    double t[3], q[4], s[3];
    for (size_t i = 0; i < 3; i++) {
        t[i] = element(node, "translation", i, 0);
        s[i] = element(node, "scale", i, 1);
    }
    for (size_t i = 0; i < 4; i++) q[i] = element(node, "rotation", i, i == 3);
    ec_gltf_compose(t, q, s, m);
}

/* MSFT_lod: hides the coarser versions that a node lists, which may be part of the scene too. The node itself is the finest. */
static void hide_coarser(const json &list, ec_gltf *gltf)
{
    for (const json &in : list)
        if (const json *lod = find_extension(in, "MSFT_lod"))
            for (const json &id : list_of(*lod, "ids")) gltf->nodes[id.get<size_t>()].hidden = true;
}

/* Warns of node matrices whose last row is not 0 0 0 1. */
static void warn_projective(const json &list, ec_gltf *gltf, const ec_log *log)
{
    for (size_t i = 0; i < list.size(); i++) {
        if (!list[i].contains("matrix")) continue;
        const double *m = gltf->nodes[i].local;
        if (m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1) continue;
        ec_warn(log, "%s: %s has a projective matrix, which glTF does not allow; its last row is taken as 0 0 0 1", gltf->path,
                ec_label_of("nodes", uint32_t(i), gltf->nodes[i].name).text);
        return;
    }
}

void convert_nodes(const json &list, ec_gltf *gltf, const ec_log *log)
{
    convert_list(list, gltf->nodes, gltf->node_count, [](const json &in, ec_gltf_node &out) {
        out.name = copy_string(in.value("name", ""));
        out.mesh = in.value("mesh", -1);
        out.skin = in.value("skin", -1);
        out.camera = in.value("camera", -1);
        const json *visibility = find_extension(in, "KHR_node_visibility");
        out.hidden = visibility && !visibility->value("visible", true);
        const json *light = find_extension(in, "KHR_lights_punctual");
        out.light = light ? (*light)["light"].get<int32_t>() : -1;
        copy_list(list_of(in, "weights"), out.weights, out.weight_count);
        if (const json *instancing = find_extension(in, "EXT_mesh_gpu_instancing")) {
            const json &attributes = (*instancing)["attributes"];
            out.instances = {true, attributes.value("TRANSLATION", -1), attributes.value("ROTATION", -1), attributes.value("SCALE", -1)};
        }
        if (in.contains("matrix"))
            for (size_t i = 0; i < 16; i++) out.local[i] = element(in, "matrix", i, 0);
        else
            compose_local(out.local, in);
        copy_list(list_of(in, "children"), out.children, out.child_count);
    });
    hide_coarser(list, gltf);
    warn_projective(list, gltf, log);
}

/* Finds the nodes of the scene to show; if the file has no scenes, all nodes without a parent. */
void set_roots(const json &root, ec_gltf *gltf)
{
    std::vector<int> roots;
    const json &scenes = list_of(root, "scenes"), &nodes = list_of(root, "nodes");
    if (!scenes.empty()) {
        for (const json &node : list_of(scenes[root.value("scene", size_t(0))], "nodes")) roots.push_back(node);
    } else {
        std::vector<bool> has_parent(nodes.size());
        for (const json &node : nodes)
            for (const json &child : list_of(node, "children")) has_parent[child.get<size_t>()] = true;
        for (size_t i = 0; i < nodes.size(); i++)
            if (!has_parent[i]) roots.push_back(int(i));
    }
    gltf->roots = make_array<int32_t>(roots.size());
    std::copy(roots.begin(), roots.end(), gltf->roots);
    gltf->root_count = uint32_t(roots.size());
}

} // namespace eclat
