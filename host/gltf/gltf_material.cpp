/* tinygltf's materials, samplers and textures to ours. */
#include "gltf/gltf_shim.h"

#include <cmath>

extern "C" {
#include "gltf/codecs.h"
}

namespace eclat {

using tinygltf::Value;

static const Value *find_extension(const tinygltf::ExtensionMap &extensions, const char *name)
{
    auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

static double get_number(const Value &object, const char *key, double fallback)
{
    if (!object.Has(key) || !object.Get(key).IsNumber()) return fallback;
    return object.Get(key).GetNumberAsDouble();
}

/* Element i of an array member. */
static double get_element(const Value &object, const char *key, int i, double fallback)
{
    if (!object.Has(key) || !object.Get(key).IsArray() || size_t(i) >= object.Get(key).ArrayLen()) return fallback;
    return object.Get(key).Get(i).GetNumberAsDouble();
}

static const ec_texture_use no_texture = {-1, 0, {1, 0, 0, 0, 1, 0}};

/* KHR_texture_transform: T x R x S, the rotation being counter-clockwise as seen with v pointing down. */
static void set_transform(ec_texture_use &use, int64_t &uv_set, const Value &t)
{
    double angle = get_number(t, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    double sx = get_element(t, "scale", 0, 1), sy = get_element(t, "scale", 1, 1);
    double matrix[6] = {c * sx, s * sy, get_element(t, "offset", 0, 0), -s * sx, c * sy, get_element(t, "offset", 1, 0)};
    for (int i = 0; i < 6; i++) use.transform[i] = float(matrix[i]);
    uv_set = int64_t(get_number(t, "texCoord", double(uv_set)));
}

static ec_texture_use make_use(int index, int64_t uv_set, const Value *transform, const std::string &where,
                               const ec_gltf *gltf, const ec_log *log)
{
    ec_texture_use use = no_texture;
    if (index < 0) return use;
    use.texture = index;
    if (transform) set_transform(use, uv_set, *transform);
    if (uv_set < 0 || uv_set > 1) {
        ec_warn(log, "%s: %s wants TEXCOORD_%lld, but only sets 0 and 1 are supported; the texture is left out",
                gltf->path, where.c_str(), (long long)uv_set);
        return no_texture;
    }
    use.uv_set = uint32_t(uv_set);
    return use;
}

static ec_texture_use make_use(const Value &extension, const char *key, const std::string &where, const ec_gltf *gltf,
                               const ec_log *log)
{
    if (!extension.Has(key)) return no_texture;
    const Value &info = extension.Get(key);
    const Value *transform = nullptr;
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
        transform = &info.Get("extensions").Get("KHR_texture_transform");
    return make_use(int(get_number(info, "index", -1)), int64_t(get_number(info, "texCoord", 0)), transform,
                    where + "." + key, gltf, log);
}

static void copy_floats(float *out, const std::vector<double> &in, size_t count)
{
    for (size_t i = 0; i < count && i < in.size(); i++) out[i] = float(in[i]);
}

static void set_specular(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf,
                         const ec_log *log)
{
    out.specular = out.specular_color[0] = out.specular_color[1] = out.specular_color[2] = 1;
    const Value *s = find_extension(in.extensions, "KHR_materials_specular");
    if (!s) return;
    out.specular = float(get_number(*s, "specularFactor", 1));
    for (int i = 0; i < 3; i++) out.specular_color[i] = float(get_element(*s, "specularColorFactor", i, 1));
    out.textures[EC_SLOT_SPECULAR] = make_use(*s, "specularTexture", where, gltf, log);
    out.textures[EC_SLOT_SPECULAR_COLOR] = make_use(*s, "specularColorTexture", where, gltf, log);
}

/* attenuationColor is what is left of white light after attenuationDistance (Beer-Lambert). What a file says of a body's
 * thickness only tells bodies from thin walls: rays find the way through by themselves. */
static void set_volume(ec_material &out, const Value &v, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    double thickness = get_number(v, "thicknessFactor", 0), distance = get_number(v, "attenuationDistance", INFINITY);
    bool odd = thickness < 0 || distance <= 0;
    out.volume = thickness > 0;
    for (int i = 0; i < 3; i++) {
        double color = get_element(v, "attenuationColor", i, 1);
        odd = odd || color < 0 || color > 1;
        double absorption = color < 1 && distance < INFINITY ? -std::log(std::fmax(color, 0)) / std::fmax(distance, 0) : 0;
        if (out.volume) out.absorption[i] = float(std::fmin(absorption, 1e30));
    }
    if (odd) ec_warn(log, "%s: %s.KHR_materials_volume has values out of range; they are clamped", gltf->path, where.c_str());
}

static void set_transmission(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf,
                             const ec_log *log)
{
    const Value *ior = find_extension(in.extensions, "KHR_materials_ior");
    const Value *transmission = find_extension(in.extensions, "KHR_materials_transmission");
    const Value *dispersion = find_extension(in.extensions, "KHR_materials_dispersion");
    out.dispersion = dispersion ? float(get_number(*dispersion, "dispersion", 0)) : 0;
    out.ior = ior ? float(get_number(*ior, "ior", 1.5)) : 1.5f;
    if (!transmission) return;
    out.transmission = float(get_number(*transmission, "transmissionFactor", 0));
    out.textures[EC_SLOT_TRANSMISSION] = make_use(*transmission, "transmissionTexture", where, gltf, log);
}

static void set_diffuse_transmission(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    const Value *d = find_extension(in.extensions, "KHR_materials_diffuse_transmission");
    if (!d) return;
    out.diffuse_transmission = float(get_number(*d, "diffuseTransmissionFactor", 0));
    for (int i = 0; i < 3; i++) out.transmission_color[i] = float(get_element(*d, "diffuseTransmissionColorFactor", i, 1));
    out.textures[EC_SLOT_DIFFUSE_TRANSMISSION] = make_use(*d, "diffuseTransmissionTexture", where, gltf, log);
    out.textures[EC_SLOT_DIFFUSE_TRANSMISSION_COLOR] = make_use(*d, "diffuseTransmissionColorTexture", where, gltf, log);
}

static void set_coat(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    out.coat_normal_scale = 1;
    const Value *c = find_extension(in.extensions, "KHR_materials_clearcoat");
    if (!c) return;
    out.coat = float(get_number(*c, "clearcoatFactor", 0));
    out.coat_roughness = float(get_number(*c, "clearcoatRoughnessFactor", 0));
    out.textures[EC_SLOT_CLEARCOAT] = make_use(*c, "clearcoatTexture", where, gltf, log);
    out.textures[EC_SLOT_CLEARCOAT_ROUGHNESS] = make_use(*c, "clearcoatRoughnessTexture", where, gltf, log);
    out.textures[EC_SLOT_CLEARCOAT_NORMAL] = make_use(*c, "clearcoatNormalTexture", where, gltf, log);
    if (c->Has("clearcoatNormalTexture")) out.coat_normal_scale = float(get_number(c->Get("clearcoatNormalTexture"), "scale", 1));
}

static void set_sheen(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    const Value *s = find_extension(in.extensions, "KHR_materials_sheen");
    if (!s) return;
    for (int i = 0; i < 3; i++) out.sheen[i] = float(get_element(*s, "sheenColorFactor", i, 0));
    out.sheen_roughness = float(get_number(*s, "sheenRoughnessFactor", 0));
    out.textures[EC_SLOT_SHEEN_COLOR] = make_use(*s, "sheenColorTexture", where, gltf, log);
    out.textures[EC_SLOT_SHEEN_ROUGHNESS] = make_use(*s, "sheenRoughnessTexture", where, gltf, log);
}

static void set_anisotropy(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    const Value *a = find_extension(in.extensions, "KHR_materials_anisotropy");
    if (!a) return;
    out.anisotropy = float(get_number(*a, "anisotropyStrength", 0));
    out.anisotropy_rotation = float(std::remainder(get_number(*a, "anisotropyRotation", 0), 6.283185307179586));
    out.textures[EC_SLOT_ANISOTROPY] = make_use(*a, "anisotropyTexture", where, gltf, log);
}

static void set_film(ec_material &out, const tinygltf::Material &in, const std::string &where, const ec_gltf *gltf, const ec_log *log)
{
    const Value *f = find_extension(in.extensions, "KHR_materials_iridescence");
    out.film_ior = 1.3f;
    if (!f) return;
    out.film = float(get_number(*f, "iridescenceFactor", 0));
    out.film_ior = float(get_number(*f, "iridescenceIor", 1.3));
    out.film_least = float(get_number(*f, "iridescenceThicknessMinimum", 100));
    out.film_most = float(get_number(*f, "iridescenceThicknessMaximum", 400));
    out.textures[EC_SLOT_IRIDESCENCE] = make_use(*f, "iridescenceTexture", where, gltf, log);
    out.textures[EC_SLOT_IRIDESCENCE_THICKNESS] = make_use(*f, "iridescenceThicknessTexture", where, gltf, log);
}

/* One more texture: roughness from the glossiness in another's alpha. */
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

/* KHR_materials_pbrSpecularGlossiness, archived. Its specular colour is the reflectance seen head-on, without metals: what
 * KHR_materials_ior has the index 0 for. Diffuse is weighed by 1 - max(F) there, by 1 - max(F0) here, so grazing views are darker. */
static void set_specular_glossiness(ec_material &out, const tinygltf::Material &in, const std::string &where, ec_gltf *gltf, const ec_log *log)
{
    const Value *s = find_extension(in.extensions, "KHR_materials_pbrSpecularGlossiness");
    if (!s || find_extension(in.extensions, "KHR_materials_specular")) return; /* a file that has both says it better there */
    double glossiness = get_number(*s, "glossinessFactor", 1);
    for (int i = 0; i < 4; i++) out.base_color[i] = float(get_element(*s, "diffuseFactor", i, 1));
    for (int i = 0; i < 3; i++) out.specular_color[i] = float(get_element(*s, "specularFactor", i, 1));
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

static void set_emission(ec_material &out, const tinygltf::Material &in)
{
    const Value *strength = find_extension(in.extensions, "KHR_materials_emissive_strength");
    double factor = strength ? get_number(*strength, "emissiveStrength", 1) : 1;
    for (size_t i = 0; i < 3 && i < in.emissiveFactor.size(); i++)
        out.emission[i] = float(in.emissiveFactor[i] * factor);
}

static void set_material(ec_material &out, const tinygltf::Material &in, const std::string &where, ec_gltf *gltf,
                         const ec_log *log)
{
    auto use = [&](const auto &info, const char *name) {
        return make_use(info.index, info.texCoord, find_extension(info.extensions, "KHR_texture_transform"),
                        where + "." + name, gltf, log);
    };
    const tinygltf::PbrMetallicRoughness &pbr = in.pbrMetallicRoughness;
    for (ec_texture_use &slot : out.textures) slot = no_texture;
    out.base_color[0] = out.base_color[1] = out.base_color[2] = out.base_color[3] = 1;
    copy_floats(out.base_color, pbr.baseColorFactor, 4);
    out.metallic = float(pbr.metallicFactor);
    out.roughness = float(pbr.roughnessFactor);
    out.normal_scale = float(in.normalTexture.scale);
    out.alpha_cutoff = float(in.alphaCutoff);
    out.alpha_mode = in.alphaMode == "MASK" ? EC_ALPHA_MASK : in.alphaMode == "BLEND" ? EC_ALPHA_BLEND : EC_ALPHA_OPAQUE;
    out.double_sided = in.doubleSided;
    out.unlit = find_extension(in.extensions, "KHR_materials_unlit") != nullptr;
    out.textures[EC_SLOT_BASE_COLOR] = use(pbr.baseColorTexture, "baseColorTexture");
    out.textures[EC_SLOT_METALLIC_ROUGHNESS] = use(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    out.textures[EC_SLOT_NORMAL] = use(in.normalTexture, "normalTexture");
    out.textures[EC_SLOT_EMISSION] = use(in.emissiveTexture, "emissiveTexture");
    set_emission(out, in);
    set_specular(out, in, where, gltf, log);
    set_transmission(out, in, where, gltf, log);
    set_diffuse_transmission(out, in, where, gltf, log);
    const Value *volume = find_extension(in.extensions, "KHR_materials_volume");
    bool passes = find_extension(in.extensions, "KHR_materials_transmission") || find_extension(in.extensions, "KHR_materials_diffuse_transmission");
    if (volume && passes) set_volume(out, *volume, where, gltf, log); /* into others nothing gets */
    set_coat(out, in, where, gltf, log);
    set_sheen(out, in, where, gltf, log);
    set_anisotropy(out, in, where, gltf, log);
    set_film(out, in, where, gltf, log);
    set_specular_glossiness(out, in, where, gltf, log);
    out.name = copy_string(in.name);
}

void convert_materials(const tinygltf::Model &model, ec_gltf *gltf, const ec_log *log)
{
    gltf->materials = make_array<ec_material>(model.materials.size());
    for (const tinygltf::Material &in : model.materials) {
        std::string where = "materials[" + std::to_string(gltf->material_count) + "]";
        if (!in.name.empty()) where += " \"" + shortened(in.name, 80) + "\"";
        set_material(gltf->materials[gltf->material_count++], in, where, gltf, log);
    }
}

static ec_wrap convert_wrap(int wrap)
{
    return wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? EC_WRAP_CLAMP
           : wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? EC_WRAP_MIRROR
                                                           : EC_WRAP_REPEAT;
}

void convert_textures(const tinygltf::Model &model, ec_gltf *gltf)
{
    gltf->textures = make_array<ec_gltf_texture>(model.textures.size());
    for (const tinygltf::Texture &in : model.textures) {
        ec_gltf_texture &out = gltf->textures[gltf->texture_count++];
        out = {in.source, EC_WRAP_REPEAT, EC_WRAP_REPEAT, false, false, 0};
        const Value *webp = find_extension(in.extensions, "EXT_texture_webp");
        if (webp && ec_has_webp) out.image = webp->Get("source").GetNumberAsInt();
        if (in.sampler < 0) continue;
        const tinygltf::Sampler &sampler = model.samplers[size_t(in.sampler)];
        out.wrap_s = convert_wrap(sampler.wrapS);
        out.wrap_t = convert_wrap(sampler.wrapT);
        out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
}

} // namespace eclat
