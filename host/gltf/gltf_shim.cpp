/* Reads a .gltf or .glb into an ec_gltf: the tree is parsed and checked once, and all parts are converted from it. tinygltf only provides constants
 * of the format, as its reader would parse the text again, and trusts what files say. */
#include "gltf/gltf_shim.h"

#include <memory>

namespace eclat {

using nlohmann::json;

/* Checks the version first: other versions have another structure. */
static void check_version(const json &root)
{
    const json asset = root.value("asset", json());
    auto text = [&](const char *key) {
        return asset.is_object() && asset.contains(key) && asset[key].is_string() ? asset[key].get<std::string>() : "";
    };
    std::string version = text("version"), minimum = text("minVersion");
    if (!version.empty() && version.compare(0, 2, "2.") != 0)
        throw bad_file("glTF version " + shortened(version, 20) + " is not supported; convert the file to glTF 2.0");
    if (!minimum.empty() && minimum != "2.0")
        throw bad_file("the file needs glTF " + shortened(minimum, 20) + "; eclat reads glTF 2.0");
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

static void load_buffer(ec_gltf_buffer &out, json &in, const std::string &where, const container &file,
                        const ec_gltf *gltf)
{
    out.length = in["byteLength"];
    uint64_t available;
    if (in.contains("uri")) {
        ec_error err;
        const std::string &uri = in["uri"].get_ref<const std::string &>();
        if (ec_gltf_uri_load(gltf, where.c_str(), uri.c_str(), &out.owned, &available, &err) != EC_OK)
            throw bad_file(err.text);
        out.data = out.owned;
        in.erase("uri"); /* frees memory: embedded buffers are large */
    } else if (&out == gltf->buffers && file.chunk) {
        out.data = file.chunk;
        available = file.chunk_length;
    } else {
        return; /* an error only when it is read */
    }
    if (out.length > available)
        throw bad_file(where + " promises " + std::to_string(out.length) + " bytes but holds " +
                       std::to_string(available) + "; the file is damaged or truncated");
}

static void load_buffers(json &list, const container &file, ec_gltf *gltf)
{
    gltf->buffers = make_array<ec_gltf_buffer>(list.size());
    for (size_t i = 0; i < list.size(); i++) {
        gltf->buffer_count++;
        load_buffer(gltf->buffers[i], list[i], "buffers[" + std::to_string(i) + "]", file, gltf);
    }
}

static void check_views(const ec_gltf *gltf)
{
    ec_error err;
    if (ec_gltf_check_views(gltf, &err) != EC_OK) throw bad_file(err.text);
}

/* Converts textures, materials, cameras and lights, which an animation may change. */
static void convert_looks(const json &root, ec_gltf *gltf, const ec_log *log)
{
    convert_cameras(list_of(root, "cameras"), gltf, log);
    convert_lights(root, gltf, log);
    convert_textures(root, gltf);
    convert_materials(list_of(root, "materials"), gltf, log);
}

static void read_document(ec_gltf *gltf, uint64_t length, const ec_scene_choice *choice, const ec_log *log)
{
    container file = parse_container(gltf->file, length);
    json &root = file.root;
    if (choice->frame) ec_gltf_digest_add(gltf, gltf->file, length);
    if (!file.chunk) { /* the JSON text is no longer needed, and with embedded buffers it is as large as the scene */
        free(gltf->file);
        gltf->file = nullptr;
    }
    check_version(root);
    check_extensions(root, gltf, log);
    check_document(root, gltf->path, log);
    check_uris(list_of(root, "buffers"), "buffers");
    check_uris(list_of(root, "images"), "images");
    if (root.contains("buffers")) load_buffers(root["buffers"], file, gltf);
    convert_images(list_of(root, "images"), gltf);
    convert_views(list_of(root, "bufferViews"), gltf);
    convert_accessors(list_of(root, "accessors"), gltf);
    check_views(gltf);
    choose_scene(root, choice, gltf);
    choose_variant(root, choice, gltf);
    std::vector<uint32_t> animations = choose_animations(root, choice, gltf, log);
    bool more = apply_moment(root, animations, choice, gltf, log);
    if (!animations.empty()) check_document(root, gltf->path, log);
    convert_meshes(list_of(root, "meshes"), gltf);
    convert_skins(list_of(root, "skins"), gltf);
    convert_nodes(list_of(root, "nodes"), gltf, log);
    set_roots(root, gltf);
    convert_image_light(root, gltf, log);
    convert_looks(root, gltf, log);
    gltf->stored_accessors = gltf->accessor_count;
    gltf->stored_meshes = gltf->mesh_count;
    gltf->frame = choice->frame;
    if (choice->frame) ec_gltf_digest_parts(gltf);
    if (choice->shutter || choice->frame) gltf->tree = new posable{std::move(root), animations, more};
}

static void pose(ec_gltf *gltf, const ec_scene_choice *choice, bool whole, const ec_log *log)
{
    posable &tree = *static_cast<posable *>(gltf->tree);
    ec_gltf_unpose(gltf);
    apply_moment(tree.root, tree.animations, choice, gltf, log);
    check_document(tree.root, gltf->path, log);
    convert_weights(list_of(tree.root, "meshes"), gltf);
    convert_nodes(list_of(tree.root, "nodes"), gltf, log);
    if (!whole && !tree.more) return;
    ec_gltf_free_looks(gltf);
    convert_looks(tree.root, gltf, log);
}

/* Calls job, and turns every exception into a message of one line. */
template <typename work> static ec_result guarded(const char *path, ec_error *err, work &&job)
{
    try {
        return job();
    } catch (const std::bad_alloc &) {
        return ec_fail(err, "%s: out of memory", path);
    } catch (const std::exception &e) {
        return ec_fail(err, "%s: %.1600s", path, printable(e.what()).c_str());
    } catch (...) {
        return ec_fail(err, "%s: cannot be read", path);
    }
}

} // namespace eclat

extern "C" ec_result ec_gltf_read(const char *path, const ec_scene_choice *choice, ec_gltf **result, const ec_log *log,
                                  ec_error *err)
{
    using namespace eclat;
    *result = nullptr;
    std::unique_ptr<ec_gltf, void (*)(ec_gltf *)> gltf(static_cast<ec_gltf *>(calloc(1, sizeof(ec_gltf))), ec_gltf_free);
    if (!gltf) return ec_fail(err, "%s: out of memory", path);
    gltf->path = path;
    gltf->follow_links = choice->follow_links;
    gltf->point_size = choice->point_size > 0 ? choice->point_size : 1;
    EC_TRY(guarded(path, err, [&] {
        std::string name = path;
        size_t slash = name.find_last_of('/');
        gltf->folder = strdup(slash == std::string::npos ? "" : name.substr(0, slash + 1).c_str());
        if (!gltf->folder) throw std::bad_alloc();
        uint64_t length;
        EC_TRY(ec_gltf_file_load(path, &gltf->file, &length, err));
        read_document(gltf.get(), length, choice, log);
        return EC_OK;
    }));
    *result = gltf.release();
    return EC_OK;
}

extern "C" ec_result ec_gltf_pose(ec_gltf *gltf, const ec_scene_choice *choice, bool whole, const ec_log *log, ec_error *err)
{
    return eclat::guarded(gltf->path, err, [&] {
        eclat::pose(gltf, choice, whole, log);
        return EC_OK;
    });
}
