/* Lists the extensions that are read and those that change no picture, and reports all others. */
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <cstring>
#include <set>

extern "C" {
#include "gltf/codecs.h"
#include "scene/material_fields.h"
}

namespace eclat {

using nlohmann::json;

/* Besides those of the fields of materials. */
static const char *const supported_extensions[] = {
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "MSFT_lod"};

/* Extensions that change no picture: they describe something for programs other than renderers or, like FB_ngon_encoding, how the file was made. */
static const char *const silent_extensions[] = {
    "AGI_stk_metadata",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_ngon_encoding",
    "KHR_audio",
    "KHR_audio_emitter",
    "KHR_implicit_shapes",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_audio_emitter",
    "MSFT_collision_primitives",
    "OMI_audio_emitter",
    "OMI_audio_ogg_vorbis",
    "OMI_collider",
    "OMI_physics_body",
    "OMI_physics_gravity",
    "OMI_physics_joint",
    "OMI_physics_shape"};

template <size_t n> static bool is_in(const char *const (&list)[n], const std::string &name)
{
    return std::find(list, list + n, name) != list + n;
}

/* Extensions that need a library, which this build may lack. */
static const struct {
    const char *name, *package;
    const bool &built;
} optional_extensions[] = {{"EXT_meshopt_compression", "libmeshoptimizer-dev", ec_has_meshopt},
                           {"EXT_texture_avif", "libavif-dev, configure with -DECLAT_AVIF=ON", ec_has_avif},
                           {"EXT_texture_webp", "libwebp-dev", ec_has_webp},
                           {"KHR_draco_mesh_compression", "libdraco-dev", ec_has_draco},
                           {"KHR_meshopt_compression", "libmeshoptimizer-dev", ec_has_meshopt},
                           {"KHR_texture_basisu", "Basis Universal's source, name its folder with -DBASISU_SOURCE=FOLDER", ec_has_basisu}};

static void refuse_unbuilt(const std::string &name)
{
    for (auto &optional : optional_extensions)
        if (name == optional.name && !optional.built)
            throw bad_file("the file requires " + name + ", which this eclat was built without; install " + optional.package +
                           " and build again, or export it without");
}

static bool is_supported(const std::string &name)
{
    const std::string place = "extensions/" + name + "/";
    for (int i = 0; i < ec_material_field_count; i++)
        if (std::strncmp(ec_material_fields[i].path, place.c_str(), place.size()) == 0) return true;
    for (auto &optional : optional_extensions)
        if (name == optional.name) return optional.built;
    return is_in(supported_extensions, name) || is_in(silent_extensions, name);
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
    for (const std::string &name : names) list += (list.empty() ? "" : ", ") + shortened(name, 100);
    return printable(list);
}

/* Allocates the list before its strings: if one fails, what there is can be freed. */
static void copy_strings(const std::set<std::string> &names, ec_scene_names &list)
{
    list.names = make_array<char *>(names.size());
    for (const std::string &name : names) {
        list.names[list.count] = copy_string(name.empty() ? "?" : name);
        ++list.count;
    }
}

void check_extensions(const json &root, ec_gltf *gltf, const ec_log *log)
{
    std::set<std::string> used = string_set(root, "extensionsUsed"), needed = string_set(root, "extensionsRequired");
    std::set<std::string> ignored, missing;
    for (const std::string &name : used)
        if (!is_supported(name)) ignored.insert(name);
    for (const std::string &name : needed)
        if (!is_supported(name)) {
            refuse_unbuilt(name);
            missing.insert(name);
        }
    if (!missing.empty())
        throw bad_file("the file requires " + comma_list(missing) + ", which eclat does not support; export it without");
    if (!ignored.empty())
        ec_warn(log, "%s: not supported, so what they describe is left out: %s", gltf->path, comma_list(ignored).c_str());
    gltf->quantized = used.count("KHR_mesh_quantization") || needed.count("KHR_mesh_quantization");
    copy_strings(used, gltf->contents.extensions);
    copy_strings(ignored, gltf->contents.ignored);
}

} // namespace eclat
