/* The shape of a glTF document as tables: what does not have it is an error that says where. Only members that eclat reads are listed. */
#include "gltf/gltf_schema.h"
#include "shared/material_fields.h"

namespace eclat {

static constexpr bool required = true;
static constexpr double huge_count = 9007199254740992.0; /* 2^53: exact in a double */

static constexpr field index(const char *name, const char *target, bool needed = false)
{
    return {name, kind::index, needed, target, nullptr, 0, 0};
}
static constexpr field indices(const char *name, const char *target, bool needed = false)
{
    return {name, kind::indices, needed, target, nullptr, 0, 0};
}
static constexpr field count(const char *name, double low = 0, bool needed = false, double high = huge_count)
{
    return {name, kind::count, needed, nullptr, nullptr, low, high};
}
static constexpr field number(const char *name, bool needed = false)
{
    return {name, kind::number, needed, nullptr, nullptr, 0, 0};
}
static constexpr double any_length = -1;
static constexpr field numbers(const char *name, double length)
{
    return {name, kind::numbers, false, nullptr, nullptr, length, length};
}
/* Arrays of arrays, of `length` elements each; rows 0: any number of them, but not none. */
static constexpr field index_rows(const char *name, const char *target, double length, double rows, bool needed)
{
    return {name, kind::index_rows, needed, target, nullptr, length, rows};
}
static constexpr field number_rows(const char *name, double length, double rows)
{
    return {name, kind::number_rows, false, nullptr, nullptr, length, rows};
}
static constexpr field plain(const char *name, kind type, bool needed = false)
{
    return {name, type, needed, nullptr, nullptr, 0, 0};
}
static constexpr field choice(const char *name, const char *allowed, bool needed = false)
{
    return {name, kind::choice, needed, allowed, nullptr, 0, 0};
}
static constexpr field object(const char *name, const schema &members, bool needed = false)
{
    return {name, kind::object, needed, nullptr, &members, 0, 0};
}
static constexpr field objects(const char *name, const schema &members, bool needed = false)
{
    return {name, kind::objects, needed, nullptr, &members, 0, 0};
}

static const field sparse_indices[] = {index("bufferView", "bufferViews", required), count("byteOffset", 0, false, int_count),
                                       choice("componentType", "5121 5123 5125", required)};
static const schema sparse_indices_s(sparse_indices);
static const field sparse_values[] = {index("bufferView", "bufferViews", required), count("byteOffset", 0, false, int_count)};
static const schema sparse_values_s(sparse_values);
static const field sparse[] = {count("count", 1, required, int_count), object("indices", sparse_indices_s, required),
                               object("values", sparse_values_s, required)};
static const schema sparse_s(sparse);
static const field accessor[] = {
    index("bufferView", "bufferViews"), count("byteOffset"), count("count", 1, required),
    choice("componentType", "5120 5121 5122 5123 5125 5126", required),
    {"type", kind::accessor_type, required, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", nullptr, 0, 0},
    plain("normalized", kind::flag),
    object("sparse", sparse_s)};
static const schema accessor_s(accessor);

static const field buffer[] = {count("byteLength", 1, required), plain("uri", kind::text)};
static const schema buffer_s(buffer);
static const field meshopt[] = {index("buffer", "buffers", required), count("byteOffset"), count("byteLength", 1, required),
                                count("byteStride", 1, required, 256), count("count", 1, required),
                                choice("mode", "ATTRIBUTES TRIANGLES INDICES", required),
                                choice("filter", "NONE OCTAHEDRAL QUATERNION EXPONENTIAL")};
static const schema meshopt_s(meshopt);
static const field view_extensions[] = {object("EXT_meshopt_compression", meshopt_s)};
static const schema view_extensions_s(view_extensions);
static const field view[] = {object("extensions", view_extensions_s),
                             index("buffer", "buffers", required), count("byteOffset"), count("byteLength", 1, required),
                             count("byteStride", 4, false, 252)};
static const schema view_s(view);

static const field attributes[] = {{"*", kind::dictionary, false, "accessors", nullptr, 0, 0}};
static const schema attributes_s(attributes);
static const field mapping[] = {indices("variants", "variants", required), index("material", "materials", required)};
static const schema mapping_s(mapping);
static const field mappings[] = {objects("mappings", mapping_s, required)};
static const schema mappings_s(mappings);
static const field nothing[] = {plain("", kind::flag)};
static const schema nothing_s(nothing);
static const field draco[] = {index("bufferView", "bufferViews", required), object("attributes", nothing_s, required)};
static const schema draco_s(draco);
static const field primitive_extensions[] = {object("KHR_draco_mesh_compression", draco_s),
                                             object("KHR_materials_variants", mappings_s)};
static const schema primitive_extensions_s(primitive_extensions);
static const field primitive[] = {object("attributes", attributes_s, required), index("indices", "accessors"),
                                  index("material", "materials"), choice("mode", "0 1 2 3 4 5 6"),
                                  objects("targets", attributes_s), object("extensions", primitive_extensions_s)};
static const schema primitive_s(primitive);
static const field mesh[] = {objects("primitives", primitive_s, required), numbers("weights", any_length),
                             plain("name", kind::text)};
static const schema mesh_s(mesh);

static const field node_light[] = {index("light", "lights", required)};
static const schema node_light_s(node_light);
static const field instancing[] = {object("attributes", attributes_s, required)};
static const schema instancing_s(instancing);
static const field visibility[] = {plain("visible", kind::flag)};
static const schema visibility_s(visibility);
static const field node_extensions[] = {object("KHR_lights_punctual", node_light_s), object("KHR_node_visibility", visibility_s),
                                        object("EXT_mesh_gpu_instancing", instancing_s)};
static const schema node_extensions_s(node_extensions);
static const field node[] = {
    indices("children", "nodes"), index("mesh", "meshes"), index("skin", "skins"), index("camera", "cameras"), numbers("matrix", 16),
    numbers("weights", any_length),
    numbers("translation", 3), numbers("rotation", 4), numbers("scale", 3), plain("name", kind::text),
    object("extensions", node_extensions_s)};
static const schema node_s(node);
static const field scene_light[] = {index("light", "image-based lights", required)};
static const schema scene_light_s(scene_light);
static const field scene_extensions[] = {object("EXT_lights_image_based", scene_light_s)};
static const schema scene_extensions_s(scene_extensions);
static const field scene[] = {indices("nodes", "nodes"), plain("name", kind::text), object("extensions", scene_extensions_s)};
static const schema scene_s(scene);
static const field skin[] = {indices("joints", "nodes", required), index("inverseBindMatrices", "accessors")};
static const schema skin_s(skin);

static const field pointer[] = {plain("pointer", kind::text, required)};
static const schema pointer_s(pointer);
static const field target_extensions[] = {object("KHR_animation_pointer", pointer_s)};
static const schema target_extensions_s(target_extensions);
static const field target[] = {index("node", "nodes"), plain("path", kind::text, required),
                               object("extensions", target_extensions_s)};
static const schema target_s(target);
static const field channel[] = {count("sampler", 0, required, int_count), object("target", target_s, required)};
static const schema channel_s(channel);
static const field keyframes[] = {index("input", "accessors", required), index("output", "accessors", required),
                                  choice("interpolation", "LINEAR STEP CUBICSPLINE")};
static const schema keyframes_s(keyframes);
static const field animation[] = {objects("channels", channel_s, required), objects("samplers", keyframes_s, required),
                                  plain("name", kind::text)};
static const schema animation_s(animation);

static const field perspective[] = {number("yfov", required), number("aspectRatio"), number("znear"), number("zfar")};
static const schema perspective_s(perspective);
static const field orthographic[] = {number("xmag", required), number("ymag", required), number("znear"), number("zfar")};
static const schema orthographic_s(orthographic);
static const field camera[] = {choice("type", "perspective orthographic", required), object("perspective", perspective_s),
                               object("orthographic", orthographic_s), plain("name", kind::text)};
static const schema camera_s(camera);

static const field image[] = {plain("uri", kind::text), index("bufferView", "bufferViews"), plain("name", kind::text)};
static const schema image_s(image);
static const field webp[] = {index("source", "images", required)};
static const schema webp_s(webp);
static const field texture_extensions[] = {object("EXT_texture_webp", webp_s)};
static const schema texture_extensions_s(texture_extensions);
static const field texture[] = {index("source", "images"), index("sampler", "samplers"), object("extensions", texture_extensions_s)};
static const schema texture_s(texture);
static const field sampler[] = {choice("magFilter", "9728 9729"),
                                choice("minFilter", "9728 9729 9984 9985 9986 9987"),
                                choice("wrapS", "10497 33071 33648"), choice("wrapT", "10497 33071 33648")};
static const schema sampler_s(sampler);

static const field transform[] = {numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                  count("texCoord", 0, false, int_count)};
static const schema transform_s(transform);
static const field info_extensions[] = {object("KHR_texture_transform", transform_s)};
static const schema info_extensions_s(info_extensions);
static const field texture_info[] = {index("index", "textures", required), count("texCoord", 0, false, int_count),
                                     number("scale"), object("extensions", info_extensions_s)};
static const schema texture_info_s(texture_info);

#define SHAPE_1(path) number(path),
#define SHAPE_3(path) numbers(path, 3),
#define SHAPE_4(path) numbers(path, 4),
#define FIELD(name, floats, value, least, most, slot, channel, effect, has, path) SHAPE_##floats(path)
#define SLOT(name, is_srgb, effect, textured, has, path) object(path, texture_info_s),
#define OF_KERNELS(...)
#define GLOSS EC_KHR "pbrSpecularGlossiness/"
static const field material[] = {
    EC_MATERIAL_FIELDS(FIELD, FIELD, OF_KERNELS, OF_KERNELS) EC_SLOTS(SLOT)
    choice("alphaMode", "OPAQUE MASK BLEND"), plain("doubleSided", kind::flag), plain("name", kind::text), object(EC_KHR "unlit", nothing_s),
    number(EC_KHR "emissive_strength/emissiveStrength"), number(EC_KHR "volume/thicknessFactor"),
    object(EC_KHR "volume/thicknessTexture", texture_info_s), number(EC_KHR "volume/attenuationDistance"),
    numbers(GLOSS "diffuseFactor", 4), object(GLOSS "diffuseTexture", texture_info_s), numbers(GLOSS "specularFactor", 3),
    number(GLOSS "glossinessFactor"), object(GLOSS "specularGlossinessTexture", texture_info_s)};
static const schema material_s(material);

static const field spot[] = {number("innerConeAngle"), number("outerConeAngle")};
static const schema spot_s(spot);
static const field light[] = {choice("type", "point spot directional", required), numbers("color", 3), number("intensity"),
                              number("range"), object("spot", spot_s), plain("name", kind::text)};
static const schema light_s(light);
static const field lights[] = {objects("lights", light_s, required)};
static const schema lights_s(lights);
static const field image_light[] = {
    numbers("rotation", 4), number("intensity"), index_rows("specularImages", "images", 6, 0, required),
    number_rows("irradianceCoefficients", 3, 9), count("specularImageSize", 1, required, int_count), plain("name", kind::text)};
static const schema image_light_s(image_light);
static const field image_lights[] = {objects("lights", image_light_s, required)};
static const schema image_lights_s(image_lights);
static const field variant[] = {plain("name", kind::text, required)};
static const schema variant_s(variant);
static const field variants[] = {objects("variants", variant_s, required)};
static const schema variants_s(variants);
static const field root_extensions[] = {object("EXT_lights_image_based", image_lights_s), object("KHR_lights_punctual", lights_s),
                                        object("KHR_materials_variants", variants_s)};
static const schema root_extensions_s(root_extensions);

static const field asset[] = {plain("version", kind::text, required), plain("minVersion", kind::text)};
static const schema asset_s(asset);
static const field document[] = {
    object("asset", asset_s, required), plain("extensionsUsed", kind::texts), plain("extensionsRequired", kind::texts),
    object("extensions", root_extensions_s), objects("buffers", buffer_s), objects("bufferViews", view_s),
    objects("accessors", accessor_s), objects("meshes", mesh_s), objects("nodes", node_s), objects("scenes", scene_s),
    objects("skins", skin_s), objects("animations", animation_s),
    index("scene", "scenes"), objects("cameras", camera_s), objects("images", image_s), objects("textures", texture_s),
    objects("samplers", sampler_s), objects("materials", material_s)};
const schema document_schema(document);

} // namespace eclat
