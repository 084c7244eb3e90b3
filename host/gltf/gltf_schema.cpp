/* The schema of glTF documents, as far as eclat reads them. A file that does not conform is refused, and the message names the wrong place. */
#include "gltf/gltf_schema.h"
#include "shared/material_fields.h"

namespace eclat {

static const bool required = true;
static const double huge_count = 9007199254740992.0; /* 2^53: exact in a double */
static const double any_length = -1;

static field index(const char *name, const char *target, bool needed = false) { return {name, kind::index, needed, target}; }
static field indices(const char *name, const char *target, bool needed = false) { return {name, kind::indices, needed, target}; }
static field count(const char *name, double low = 0, bool needed = false, double high = huge_count)
{
    return {name, kind::count, needed, nullptr, low, high};
}
static field number(const char *name, bool needed = false) { return {name, kind::number, needed}; }
static field numbers(const char *name, double length) { return {name, kind::numbers, false, nullptr, length, length}; }
static field plain(const char *name, kind type, bool needed = false) { return {name, type, needed}; }
static field choice(const char *name, const char *allowed, bool needed = false) { return {name, kind::choice, needed, allowed}; }
static field object(const char *name, const schema &members, bool needed = false)
{
    return {name, kind::object, needed, nullptr, 0, 0, members};
}
static field objects(const char *name, const schema &members, bool needed = false)
{
    return {name, kind::objects, needed, nullptr, 0, 0, members};
}

static const field name = plain("name", kind::text);
static const field offset = count("byteOffset"), small_offset = count("byteOffset", 0, false, int_count);
static const schema attributes = {{"*", kind::dictionary, false, "accessors"}};

static const schema accessor = {
    index("bufferView", "bufferViews"), offset, count("count", 1, required),
    choice("componentType", "5120 5121 5122 5123 5125 5126", required),
    {"type", kind::accessor_type, required, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    plain("normalized", kind::flag),
    object("sparse", {count("count", 1, required, int_count),
                      object("indices", {index("bufferView", "bufferViews", required), small_offset,
                                         choice("componentType", "5121 5123 5125", required)}, required),
                      object("values", {index("bufferView", "bufferViews", required), small_offset}, required)})};

static const schema meshopt = {
    index("buffer", "buffers", required), offset, count("byteLength", 1, required), count("byteStride", 1, required, 256),
    count("count", 1, required), choice("mode", "ATTRIBUTES TRIANGLES INDICES", required),
    choice("filter", "NONE OCTAHEDRAL QUATERNION EXPONENTIAL COLOR")};
static const schema view = {
    object("extensions", {object("EXT_meshopt_compression", meshopt), object("KHR_meshopt_compression", meshopt)}), index("buffer", "buffers", required), offset,
    count("byteLength", 1, required), count("byteStride", 4, false, 252)};

static const schema mapping = {indices("variants", "variants", required), index("material", "materials", required)};
static const schema draco = {index("bufferView", "bufferViews", required), object("attributes", {}, required)};
static const schema primitive = {
    object("attributes", attributes, required), index("indices", "accessors"), index("material", "materials"),
    choice("mode", "0 1 2 3 4 5 6"), objects("targets", attributes),
    object("extensions", {object("KHR_draco_mesh_compression", draco),
                          object("KHR_materials_variants", {objects("mappings", mapping, required)})})};
static const schema mesh = {objects("primitives", primitive, required), numbers("weights", any_length), name};

static const schema node = {
    indices("children", "nodes"), index("mesh", "meshes"), index("skin", "skins"), index("camera", "cameras"),
    numbers("matrix", 16), numbers("weights", any_length), numbers("translation", 3), numbers("rotation", 4),
    numbers("scale", 3), name,
    object("extensions", {object("KHR_lights_punctual", {index("light", "lights", required)}),
                          object("KHR_node_visibility", {plain("visible", kind::flag)}), object("MSFT_lod", {indices("ids", "nodes", required)}),
                          object("EXT_mesh_gpu_instancing", {object("attributes", attributes, required)})})};
static const schema scene = {
    indices("nodes", "nodes"), name,
    object("extensions", {object("EXT_lights_image_based", {index("light", "image-based lights", required)})})};
static const schema skin = {indices("joints", "nodes", required), index("inverseBindMatrices", "accessors")};

static const schema target = {
    index("node", "nodes"), plain("path", kind::text, required),
    object("extensions", {object("KHR_animation_pointer", {plain("pointer", kind::text, required)})})};
static const schema channel = {count("sampler", 0, required, int_count), object("target", target, required)};
static const schema keyframes = {index("input", "accessors", required), index("output", "accessors", required),
                                 choice("interpolation", "LINEAR STEP CUBICSPLINE")};
static const schema animation = {objects("channels", channel, required), objects("samplers", keyframes, required), name};

static const schema camera = {
    choice("type", "perspective orthographic", required),
    object("perspective", {number("yfov", required), number("aspectRatio"), number("znear"), number("zfar")}),
    object("orthographic", {number("xmag", required), number("ymag", required), number("znear"), number("zfar")}), name};

static const schema image = {plain("uri", kind::text), index("bufferView", "bufferViews"), name};
static const schema texture = {
    count("source", 0, false, int_count), index("sampler", "samplers"), /* a texture that nothing uses need not have an image: check_sources */
    object("extensions", {object("EXT_texture_avif", {index("source", "images", required)}),
                          object("EXT_texture_webp", {index("source", "images", required)}),
                          object("KHR_texture_basisu", {index("source", "images", required)})})};
static const schema sampler = {
    choice("magFilter", "9728 9729"), choice("minFilter", "9728 9729 9984 9985 9986 9987"),
    choice("wrapS", "10497 33071 33648"), choice("wrapT", "10497 33071 33648")};

static const field uv_set = count("texCoord", 0, false, int_count);
static const schema transform = {numbers("offset", 2), number("rotation"), numbers("scale", 2), uv_set};
static const schema texture_info = {index("index", "textures", required), uv_set, number("scale"),
                                    object("extensions", {object("KHR_texture_transform", transform)})};

#define SHAPE_1(path) number(path),
#define SHAPE_3(path) numbers(path, 3),
#define SHAPE_4(path) numbers(path, 4),
#define FIELD(name, floats, value, least, most, slot, channel, effect, has, path) SHAPE_##floats(path)
#define SLOT(name, is_srgb, effect, textured, has, path) object(path, texture_info),
#define OF_KERNELS(...)
#define GLOSS EC_KHR "pbrSpecularGlossiness/"
static const schema material = {
    EC_MATERIAL_FIELDS(FIELD, FIELD, OF_KERNELS, OF_KERNELS) EC_SLOTS(SLOT)
    choice("alphaMode", "OPAQUE MASK BLEND"), plain("doubleSided", kind::flag), name, object(EC_KHR "unlit", {}),
    number(EC_KHR "emissive_strength/emissiveStrength"), number(EC_KHR "volume/thicknessFactor"),
    object(EC_KHR "volume/thicknessTexture", texture_info), number(EC_KHR "volume/attenuationDistance"),
    numbers(EC_KHR "volume_scatter/multiscatterColor", 3),
    numbers(GLOSS "diffuseFactor", 4), object(GLOSS "diffuseTexture", texture_info), numbers(GLOSS "specularFactor", 3),
    number(GLOSS "glossinessFactor"), object(GLOSS "specularGlossinessTexture", texture_info)};

static const schema light = {
    choice("type", "point spot directional", required), numbers("color", 3), number("intensity"), number("range"),
    object("spot", {number("innerConeAngle"), number("outerConeAngle")}), name};
static const schema image_light = {
    numbers("rotation", 4), number("intensity"),
    {"specularImages", kind::index_rows, required, "images", 6, 0}, {"irradianceCoefficients", kind::number_rows, false, nullptr, 3, 9},
    count("specularImageSize", 1, required, int_count), name};
static const schema root_extensions = {
    object("EXT_lights_image_based", {objects("lights", image_light, required)}),
    object("KHR_lights_punctual", {objects("lights", light, required)}),
    object("KHR_materials_variants", {objects("variants", {plain("name", kind::text, required)}, required)})};

const schema document_schema = {
    object("asset", {plain("version", kind::text, required), plain("minVersion", kind::text)}, required),
    plain("extensionsUsed", kind::texts), plain("extensionsRequired", kind::texts), object("extensions", root_extensions),
    objects("buffers", {count("byteLength", 1, required), plain("uri", kind::text)}), objects("bufferViews", view),
    objects("accessors", accessor), objects("meshes", mesh), objects("nodes", node), objects("scenes", scene),
    objects("skins", skin), objects("animations", animation), index("scene", "scenes"), objects("cameras", camera),
    objects("images", image), objects("textures", texture), objects("samplers", sampler), objects("materials", material)};

} // namespace eclat
