/* Writes the chosen scene and material variant into the tree. */
#include "gltf/gltf_shim.h"

namespace eclat {

using nlohmann::json;

void list_names(const json &list, ec_scene_names *out)
{
    out->names = make_array<char *>(list.size());
    for (const json &item : list) out->names[out->count++] = copy_string(item.value("name", ""));
}

uint32_t find_choice(const ec_scene_names *names, const char *what, const char *wanted)
{
    ec_error err;
    uint32_t index = 0;
    if (ec_scene_names_find(names, what, wanted, &index, &err) != EC_OK) throw bad_file(err.text);
    return index;
}

void choose_scene(json &root, const ec_scene_choice *choice, ec_gltf *gltf)
{
    ec_scene_contents &contents = gltf->contents;
    list_names(list_of(root, "scenes"), &contents.scenes);
    if (choice->scene) root["scene"] = find_choice(&contents.scenes, "scene", choice->scene);
    contents.scene = root.value("scene", 0u);
}

static int material_of(const json &primitive, uint32_t variant)
{
    const json *variants = find_extension(primitive, "KHR_materials_variants");
    if (!variants) return -1;
    for (const json &mapping : (*variants)["mappings"])
        for (const json &named : mapping["variants"])
            if (named == variant) return mapping["material"];
    return -1;
}

/* Gives primitives the material of the chosen variant; those without a mapping for it keep theirs. */
void choose_variant(json &root, const ec_scene_choice *choice, ec_gltf *gltf)
{
    ec_scene_names &names = gltf->contents.variants;
    const json *extension = find_extension(root, "KHR_materials_variants");
    if (extension) list_names((*extension)["variants"], &names);
    if (!choice->variant) return;
    uint32_t variant = find_choice(&names, "variant", choice->variant);
    if (!root.contains("meshes")) return;
    for (json &mesh : root["meshes"])
        for (json &primitive : mesh["primitives"]) {
            int material = material_of(primitive, variant);
            if (material >= 0) primitive["material"] = material;
        }
}

} // namespace eclat
