/* Converts materials by the rows of shared/material_fields.h and special rules beyond these, and textures with their samplers. */
#include "gltf/gltf_shim.h"

#include <cmath>
#include <cstring>

extern "C" {
#include "gltf/codecs.h"
#include "scene/material_fields.h"
}

namespace eclat {

using nlohmann::json;

/* Returns the value at a path; NULL if the file does not have it. */
static const json *find_path(const json &material, const char *path)
{
    const json *at = &material;
    while (*path) {
        const std::string step(path, std::strcspn(path, "/"));
        auto found = at->find(step);
        if (found == at->end()) return nullptr;
        at = &*found;
        path += step.size() + (path[step.size()] == '/');
    }
    return at;
}

static const ec_texture_use no_texture = {-1, 0, {1, 0, 0, 0, 1, 0}};

/* KHR_texture_transform: T x R x S; the rotation is counter-clockwise if v points down. */
static void set_transform(ec_texture_use &use, int64_t &uv_set, const json &t)
{
    double angle = t.value("rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
    double sx = element(t, "scale", 0, 1), sy = element(t, "scale", 1, 1);
    double matrix[6] = {c * sx, s * sy, element(t, "offset", 0, 0), -s * sx, c * sy, element(t, "offset", 1, 0)};
    for (int i = 0; i < 6; i++) use.transform[i] = float(matrix[i]);
    uv_set = t.value("texCoord", uv_set);
}

static ec_texture_use make_use(const json &material, const char *path, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    ec_texture_use use = no_texture;
    const json *info = find_path(material, path);
    if (!info) return use;
    int64_t uv_set = info->value("texCoord", int64_t(0));
    const json *transform = find_extension(*info, "KHR_texture_transform");
    if (transform) set_transform(use, uv_set, *transform);
    if (uv_set < 0 || uv_set > 1) {
        const char *slash = std::strrchr(path, '/');
        ec_warn(log, "%s: %s.%s uses TEXCOORD_%lld, but only sets 0 and 1 are supported; the texture is left out", gltf->path, where.c_str(),
                slash ? slash + 1 : path, (long long)uv_set);
        return no_texture;
    }
    use.texture = info->value("index", -1);
    use.uv_set = uint32_t(uv_set);
    return use;
}

static void set_field(ec_material &out, const ec_material_field &field, const json &material)
{
    const json *said = find_path(material, field.path);
    float *floats = ec_material_floats(&out, &field);
    for (int i = 0; said && i < field.floats; i++) floats[i] = said->is_array() ? (*said)[size_t(i)].get<float>() : said->get<float>();
}

/* Sets absorption: attenuationColor is what is left of white light after attenuationDistance (Beer-Lambert). The thickness in the file only
 * distinguishes bodies from thin walls; rays find the way through by themselves. */
static void set_volume(ec_material &out, const json &v, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    double thickness = v.value("thicknessFactor", 0.0), distance = v.value("attenuationDistance", double(INFINITY));
    bool odd = thickness < 0 || distance <= 0;
    out.volume = thickness > 0;
    for (size_t i = 0; i < 3; i++) {
        double color = element(v, "attenuationColor", i, 1);
        odd = odd || color < 0 || color > 1;
        double absorption = color < 1 && distance < INFINITY ? -std::log(std::fmax(color, 0)) / std::fmax(distance, 0) : 0;
        if (out.volume) out.absorption[i] = float(std::fmin(absorption, 1e30));
    }
    if (odd) ec_warn(log, "%s: %s.KHR_materials_volume has values out of range; they are clamped", gltf->path, where.c_str());
}

/* Appends a texture that takes roughness from the glossiness in another texture's alpha. */
static int32_t append_gloss(ec_gltf *gltf, int32_t texture, double factor)
{
    auto *grown = static_cast<ec_gltf_texture *>(realloc(gltf->textures, (size_t(gltf->texture_count) + 1) * sizeof *gltf->textures));
    if (!grown) throw std::bad_alloc();
    gltf->textures = grown;
    grown[gltf->texture_count] = grown[texture];
    grown[gltf->texture_count].is_gloss = true;
    grown[gltf->texture_count].glossiness = float(std::fmin(std::fmax(factor, 0), 1));
    return int32_t(gltf->texture_count++);
}

/* KHR_materials_pbrSpecularGlossiness, archived. Its specular colour is the reflectance seen head-on, without metals: what KHR_materials_ior has the
 * index 0 for. Diffuse is weighted by 1 - max(F) there, by 1 - max(F0) here, so grazing views are darker. */
static void set_specular_glossiness(ec_material &out, const json &in, const std::string &where, ec_gltf *gltf, const ec_log *log)
{
    const json *s = find_extension(in, "KHR_materials_pbrSpecularGlossiness");
    if (!s || find_extension(in, "KHR_materials_specular")) return; /* which describes it better if a file has both */
    double glossiness = s->value("glossinessFactor", 1.0);
    for (size_t i = 0; i < 4; i++) out.base_color[i] = float(element(*s, "diffuseFactor", i, 1));
    for (size_t i = 0; i < 3; i++) out.specular_color[i] = float(element(*s, "specularFactor", i, 1));
    out.ior = out.metallic = 0;
    out.specular = 1;
    out.roughness = float(1 - glossiness);
    out.textures[EC_SLOT_BASE_COLOR] = make_use(*s, "diffuseTexture", where, gltf, log);
    out.textures[EC_SLOT_SPECULAR_COLOR] = make_use(*s, "specularGlossinessTexture", where, gltf, log);
    ec_texture_use &roughness = out.textures[EC_SLOT_METALLIC_ROUGHNESS] = out.textures[EC_SLOT_SPECULAR_COLOR];
    if (roughness.texture < 0) return;
    roughness.texture = append_gloss(gltf, roughness.texture, glossiness);
    out.roughness = 1;
}

static void set_material(ec_material &out, const json &in, const std::string &where, ec_gltf *gltf, const ec_log *log)
{
    out = ec_material_default();
    for (int i = 0; i < ec_material_field_count; i++) set_field(out, ec_material_fields[i], in);
    for (int i = 0; i < EC_SLOT_COUNT; i++) out.textures[i] = make_use(in, ec_material_slots[i].path, where, gltf, log);
    const std::string mode = in.value("alphaMode", "OPAQUE");
    out.alpha_mode = mode == "MASK" ? EC_ALPHA_MASK : mode == "BLEND" ? EC_ALPHA_BLEND : EC_ALPHA_OPAQUE;
    out.double_sided = in.value("doubleSided", false);
    out.unlit = find_extension(in, "KHR_materials_unlit") != nullptr;
    if (const json *strength = find_extension(in, "KHR_materials_emissive_strength"))
        for (size_t i = 0; i < 3; i++)
            out.emission[i] = float(element(in, "emissiveFactor", i, 0) * strength->value("emissiveStrength", 1.0));
    if (const json *anisotropy = find_extension(in, "KHR_materials_anisotropy"))
        out.anisotropy_rotation = float(std::remainder(anisotropy->value("anisotropyRotation", 0.0), 6.283185307179586));
    if (const json *older = find_path(in, EC_KHR "volume_scatter/multiscatterColor")) /* of drafts of the extension before 2026 */
        for (size_t i = 0; i < 3; i++) out.scatter[i] = (*older)[i].get<float>();
    if (find_path(in, EC_KHR "volume_scatter/multiscatterColorTexture"))
        ec_warn(log, "%s: %s has a multiscatterColorTexture, which is left out: a body scatters the same everywhere", gltf->path, where.c_str());
    const json *volume = find_extension(in, "KHR_materials_volume");
    for (float &absorption : out.absorption) absorption = 0; /* the file has a colour in its place */
    bool passes = find_extension(in, "KHR_materials_transmission") || find_extension(in, "KHR_materials_diffuse_transmission");
    if (volume && passes) set_volume(out, *volume, where, gltf, log); /* nothing gets into other bodies */
    set_specular_glossiness(out, in, where, gltf, log);
    out.name = copy_string(in.value("name", ""));
}

void convert_materials(const json &list, ec_gltf *gltf, const ec_log *log)
{
    gltf->materials = make_array<ec_material>(list.size());
    for (const json &in : list) {
        std::string where = "materials[" + std::to_string(gltf->material_count) + "]", name = in.value("name", "");
        if (!name.empty()) where += " \"" + shortened(name, 80) + "\"";
        set_material(gltf->materials[gltf->material_count++], in, where, gltf, log);
    }
}

static ec_wrap convert_wrap(int wrap)
{
    return wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? EC_WRAP_CLAMP
           : wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? EC_WRAP_MIRROR
                                                           : EC_WRAP_REPEAT;
}

void convert_textures(const json &root, ec_gltf *gltf)
{
    const json &samplers = list_of(root, "samplers");
    convert_list(list_of(root, "textures"), gltf->textures, gltf->texture_count, [&](const json &in, ec_gltf_texture &out) {
        const json *other = ec_has_basisu ? find_extension(in, "KHR_texture_basisu") : nullptr;
        if (!other && ec_has_avif) other = find_extension(in, "EXT_texture_avif");
        if (!other && ec_has_webp) other = find_extension(in, "EXT_texture_webp");
        out = {(other ? *other : in).value("source", -1), EC_WRAP_REPEAT, EC_WRAP_REPEAT, false, false, 0};
        if (!in.contains("sampler")) return;
        const json &sampler = samplers[in["sampler"].get<size_t>()];
        out.wrap_s = convert_wrap(sampler.value("wrapS", TINYGLTF_TEXTURE_WRAP_REPEAT));
        out.wrap_t = convert_wrap(sampler.value("wrapT", TINYGLTF_TEXTURE_WRAP_REPEAT));
        out.nearest = sampler.value("magFilter", TINYGLTF_TEXTURE_FILTER_LINEAR) == TINYGLTF_TEXTURE_FILTER_NEAREST;
    });
}

} // namespace eclat
