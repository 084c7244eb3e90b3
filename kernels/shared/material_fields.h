/* Lists each field of a material, and each texture that it may have, once. From these rows come ec_material, the kernels' record of it, and all that
 * reads, checks, folds, packs, leaves out and reports materials (host/scene/material_fields.h). */
#ifndef EC_SHARED_MATERIAL_FIELDS_H
#define EC_SHARED_MATERIAL_FIELDS_H

/* In the order of the kernels' record, in fours of words.
 *   F(field, floats, default, least, most, SLOT, channel, EFFECT, has, path): as files have it, and as kernels read it
 *   S(the same): as files have it; host/pack/pack.c computes what kernels get for it
 *   P(type, field): one word, for kernels alone. V(field): three floats, for kernels alone
 * SLOT and channel: the texture whose channels, from that one on, multiply it. EFFECT: the effect that the field weighs: at 0 there is none of it,
 * and --without sets that. has: what a report says of a material with that effect; 0: host/pack/features.c says what more it takes. path: in glTF's
 * material, from where host/gltf/gltf_material.cpp takes it as it is unless it says otherwise. */
#define EC_KHR "extensions/KHR_materials_"
#define EC_MATERIAL_FIELDS(F, S, P, V) \
    F(base_color, 4, 1, 0, 1, BASE_COLOR, 0, NONE, 0, "pbrMetallicRoughness/baseColorFactor") /* linear; alpha: coverage */ \
    F(emission, 3, 0, 0, EC_RADIANCE_MOST, EMISSION, 0, EMISSION, "emits", "emissiveFactor") /* radiance: times emissiveStrength */ \
    P(ec_uint, flags) /* EC_MATERIAL_* */ \
    F(metallic, 1, 1, 0, 1, METALLIC_ROUGHNESS, 2, SPECULAR, 0, "pbrMetallicRoughness/metallicFactor") \
    F(roughness, 1, 1, 0, 1, METALLIC_ROUGHNESS, 1, NONE, 0, "pbrMetallicRoughness/roughnessFactor") /* alpha_ggx = roughness^2 */ \
    F(normal_scale, 1, 1, -1e30f, 1e30f, NONE, 0, NONE, 0, "normalTexture/scale") \
    F(alpha_cutoff, 1, 0.5f, 0, 1e30f, NONE, 0, NONE, 0, "alphaCutoff") \
    S(specular_color, 3, 1, 0, 1e30f, SPECULAR_COLOR, 0, NONE, 0, EC_KHR "specular/specularColorFactor") /* may exceed 1 */ \
    V(f0) /* specular_color times the dielectric's reflectance head-on */ \
    F(specular, 1, 1, 0, 1, SPECULAR, 3, SPECULAR, 0, EC_KHR "specular/specularFactor") \
    F(absorption, 3, 0, 0, 1e30f, NONE, 0, ABSORPTION, "absorbs in its volume", EC_KHR "volume/attenuationColor") /* 1/m, worked out */ \
    F(transmission, 1, 0, 0, 1, TRANSMISSION, 0, TRANSMISSION, "has transmission", EC_KHR "transmission/transmissionFactor") \
    F(ior, 1, 1.5f, 1, 1e3f, NONE, 0, NONE, 0, EC_KHR "ior/ior") /* 0, out of range, stays: reflects all */ \
    F(dispersion, 1, 0, 0, 1e3f, NONE, 0, DISPERSION, "has dispersion", EC_KHR "dispersion/dispersion") /* 20 / Abbe number */ \
    P(ec_uint, body)         /* with NESTED: bit of this material in sets of bodies */ \
    P(ec_uint, body_of_rank) /* of material k: first word of that of the body of rank k */ \
    F(coat, 1, 0, 0, 1, CLEARCOAT, 0, CLEARCOAT, "has clear coat", EC_KHR "clearcoat/clearcoatFactor") \
    F(coat_roughness, 1, 0, 0, 1, CLEARCOAT_ROUGHNESS, 1, NONE, 0, EC_KHR "clearcoat/clearcoatRoughnessFactor") \
    F(coat_normal_scale, 1, 1, -1e30f, 1e30f, NONE, 0, NONE, 0, EC_KHR "clearcoat/clearcoatNormalTexture/scale") \
    P(ec_float, coat_pad) \
    F(sheen, 3, 0, 0, 1, SHEEN_COLOR, 0, SHEEN, "has sheen", EC_KHR "sheen/sheenColorFactor") \
    F(sheen_roughness, 1, 0, 0, 1, SHEEN_ROUGHNESS, 3, NONE, 0, EC_KHR "sheen/sheenRoughnessFactor") \
    F(anisotropy, 1, 0, 0, 1, NONE, 0, ANISOTROPY, 0, EC_KHR "anisotropy/anisotropyStrength") \
    S(anisotropy_rotation, 1, 0, -7, 7, NONE, 0, NONE, 0, EC_KHR "anisotropy/anisotropyRotation") /* radians from the tangent */ \
    P(ec_float, anisotropy_cosine) \
    P(ec_float, anisotropy_sine) \
    P(ec_float, anisotropy_pad) \
    F(transmission_color, 3, 1, 0, 1, DIFFUSE_TRANSMISSION_COLOR, 0, NONE, 0, EC_KHR "diffuse_transmission/diffuseTransmissionColorFactor") \
    F(diffuse_transmission, 1, 0, 0, 1, DIFFUSE_TRANSMISSION, 3, DIFFUSE_TRANSMISSION, "has diffuse transmission", \
      EC_KHR "diffuse_transmission/diffuseTransmissionFactor") \
    S(scatter, 3, 0, 0, 1, NONE, 0, SCATTERING, "scatters light in its volume", EC_KHR "volume_scatter/multiscatterColorFactor") /* after many events */ \
    V(scatter_albedo) /* share that goes on after one */ \
    F(scatter_anisotropy, 1, 0, -0.999f, 0.999f, NONE, 0, NONE, 0, EC_KHR "volume_scatter/scatterAnisotropy") /* mean cosine; its absorption is all extinction */ \
    F(film, 1, 0, 0, 1, IRIDESCENCE, 0, IRIDESCENCE, "has iridescence", EC_KHR "iridescence/iridescenceFactor") \
    F(film_ior, 1, 1.3f, 1, 1e3f, NONE, 0, NONE, 0, EC_KHR "iridescence/iridescenceIor") \
    F(film_least, 1, 100, 0, 1e6f, NONE, 0, NONE, 0, EC_KHR "iridescence/iridescenceThicknessMinimum") /* nm, texture 0 */ \
    F(film_most, 1, 400, 0, 1e6f, NONE, 0, NONE, 0, EC_KHR "iridescence/iridescenceThicknessMaximum") /* and 1 */

/* T(SLOT, is it sRGB? a colour is, a number is not; EFFECT without which nobody looks at it, EFFECT that reads it, has, path) */
#define EC_SLOTS(T) \
    T(BASE_COLOR, 1, NONE, BASE_COLOR_TEXTURE, 0, "pbrMetallicRoughness/baseColorTexture") /* alpha, which is linear, is coverage */ \
    T(METALLIC_ROUGHNESS, 0, NONE, METALLIC_ROUGHNESS_TEXTURE, 0, "pbrMetallicRoughness/metallicRoughnessTexture") /* G roughness, B metallic */ \
    T(NORMAL, 0, NONE, NORMAL_TEXTURE, "has a normal map", "normalTexture") \
    T(EMISSION, 1, EMISSION, EMISSION_TEXTURE, "has an emissive texture", "emissiveTexture") \
    T(SPECULAR, 0, SPECULAR, SPECULAR_TEXTURE, 0, EC_KHR "specular/specularTexture") /* A */ \
    T(SPECULAR_COLOR, 1, SPECULAR, SPECULAR_TEXTURE, 0, EC_KHR "specular/specularColorTexture") \
    T(TRANSMISSION, 0, TRANSMISSION, TRANSMISSION_TEXTURE, "has a transmission texture", EC_KHR "transmission/transmissionTexture") /* R */ \
    T(CLEARCOAT, 0, CLEARCOAT, CLEARCOAT_TEXTURE, "has a texture of its clear coat", EC_KHR "clearcoat/clearcoatTexture") /* R */ \
    T(CLEARCOAT_ROUGHNESS, 0, CLEARCOAT, CLEARCOAT_TEXTURE, "has a texture of its clear coat", EC_KHR "clearcoat/clearcoatRoughnessTexture") /* G */ \
    T(CLEARCOAT_NORMAL, 0, CLEARCOAT, CLEARCOAT_NORMAL_TEXTURE, "has a normal map of its clear coat", EC_KHR "clearcoat/clearcoatNormalTexture") \
    T(SHEEN_COLOR, 1, SHEEN, SHEEN_TEXTURE, "has a texture of its sheen", EC_KHR "sheen/sheenColorTexture") \
    T(SHEEN_ROUGHNESS, 0, SHEEN, SHEEN_TEXTURE, "has a texture of its sheen", EC_KHR "sheen/sheenRoughnessTexture") /* A */ \
    T(ANISOTROPY, 0, ANISOTROPY, ANISOTROPY_TEXTURE, 0, EC_KHR "anisotropy/anisotropyTexture") /* RG direction, B strength */ \
    T(IRIDESCENCE, 0, IRIDESCENCE, IRIDESCENCE_TEXTURE, "has a texture of its film", EC_KHR "iridescence/iridescenceTexture") /* R */ \
    T(IRIDESCENCE_THICKNESS, 0, IRIDESCENCE, IRIDESCENCE_TEXTURE, "has a texture of its film", \
      EC_KHR "iridescence/iridescenceThicknessTexture") /* G */ \
    T(DIFFUSE_TRANSMISSION, 0, DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION_TEXTURE, "has a texture of its diffuse transmission", \
      EC_KHR "diffuse_transmission/diffuseTransmissionTexture") /* A */ \
    T(DIFFUSE_TRANSMISSION_COLOR, 1, DIFFUSE_TRANSMISSION, DIFFUSE_TRANSMISSION_TEXTURE, "has a texture of its diffuse transmission", \
      EC_KHR "diffuse_transmission/diffuseTransmissionColorTexture")

#define EC_SLOT_ENUM(name, is_srgb, effect, textured, has, path) EC_SLOT_##name,
enum ec_slot { EC_SLOTS(EC_SLOT_ENUM) EC_SLOT_COUNT, EC_SLOT_NONE = -1 };

#endif
