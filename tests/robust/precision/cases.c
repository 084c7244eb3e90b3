/* The cases: function, inputs, results. `roundings` counts the rounding operations on the longest way from an input to a result. A division
 * or a root counts as one, a library function as its bound in ulps. Where a result is a difference, the ways to both operands count.
 *
 * Maps and textures have texels between 1 and 2. So rounding u or v moves a result by as many u as there are texels; the environment's 16
 * are in its count.
 *
 * Left out: headers that only look up, compare or count (filter.h, queue.h, seen.h, sort_rays.h, tally.h, traverse_*.h), and hashes
 * (sampler.h). These are exact. */
#include <stddef.h>

#include "robust/precision/draw.h"
#include "robust/precision/inputs.h"

#define EACH(name, first, words) {name, first, words, EC_PRECISION_EACH}
#define VECTOR(name, first) {name, first, 3, EC_PRECISION_VECTOR}
#define SCALED(name, first, words) {name, first, words, EC_PRECISION_SCALED}
#define STATED(name, first, words) {name, first, words, EC_PRECISION_STATED}
#define BIT(k) (1ull << (k))

const ec_precision_case ec_precision_cases[] = {
    {"sincos_2pi", "sincos_2pi", "elementary.h", ec_inputs_turn, 1, 0, 0, 4, {EACH("sin, cos", 0, 2)}},
    {"exp_negative", "exp_negative", "elementary.h", ec_inputs_exponent, 1, 0, 0, 4, {EACH("exp", 0, 1)}},
    {"log_unit", "log_unit", "elementary.h", ec_inputs_logarithm, 2, 0, 0, 6, {EACH("log", 0, 1)}},
    {"atan2_over_2pi", "atan2_over_2pi", "elementary.h", ec_inputs_plane, 2, 0, 0, 6, {EACH("angle", 0, 1)}},
    {"v3_dot", "v3_dot", "math.h", ec_inputs_two_vectors, 6, 0, 0, 3, {EACH("a . b", 0, 1)}},
    {"v3_cross", "v3_cross", "math.h", ec_inputs_two_vectors, 6, 0, 0, 2, {EACH("a x b", 0, 3)}},
    {"v3_normalize", "v3_normalize", "math.h", ec_inputs_vector, 3, 0, 0, 6, {EACH("a / length", 0, 3)}},
    {"luminance", "luminance", "math.h", ec_inputs_colour, 3, 0, 0, 4, {EACH("Y", 0, 1)}},
    {"v3_frame", "v3_frame", "math.h", ec_inputs_direction, 3, 0, 0, 6, {VECTOR("s", 0), VECTOR("t", 3)}},
    {"mis_weight", "mis_weight", "math.h", ec_inputs_densities, 2, 0, 0, 4, {EACH("w", 0, 1)}},

    {"pow5", "pow5", "fresnel.h", ec_inputs_share, 1, 0, 0, 3, {EACH("x^5", 0, 1)}},
    {"refracted_cosine2", "refracted_cosine2", "fresnel.h", ec_inputs_interface, 2, 0, 0, 4, {EACH("(eta cos)^2", 0, 1)}},
    {"fresnel_dielectric", "fresnel_dielectric", "fresnel.h", ec_inputs_interface, 2, 0, 0, 12, {EACH("F", 0, 1)}},
    {"refract", "refract", "fresnel.h", ec_inputs_refraction, 7, 0, 0, 12, {VECTOR("direction", 0)}},

    {"bsdf_make, opaque", "bsdf_make", "bsdf.h", ec_inputs_opaque, 15, BIT(14), 0, 16, {EACH("p of the lobe", 0, 1)}},
    {"bsdf_make, glass", "bsdf_make", "bsdf.h", ec_inputs_off_glass, 15, 0, 0, 24, {EACH("p of the lobe", 0, 1)}},
    {"bsdf_fresnel, opaque", "bsdf_fresnel", "bsdf.h", ec_inputs_opaque, 16, BIT(14), 0, 8, {EACH("F", 0, 3), SCALED("rest", 3, 1)}},
    {"bsdf_fresnel, glass", "bsdf_fresnel", "bsdf.h", ec_inputs_off_glass, 16, 0, 0, 20, {EACH("F", 0, 3), SCALED("rest", 3, 1)}},
    {"ggx_d", "ggx_d", "ggx.h", ec_inputs_half_vector, 15, BIT(14), 0, 8, {EACH("D", 0, 1)}},
    {"ggx_lambda", "ggx_lambda", "ggx.h", ec_inputs_half_vector, 15, BIT(14), 0, 5, {EACH("lambda", 0, 1)}},
    {"ggx_d, stretched", "ggx_d", "ggx.h", ec_inputs_brushed_half_vector, 19, BIT(14), 0, 12, {EACH("D", 0, 1)}},
    {"ggx_lambda, stretched", "ggx_lambda", "ggx.h", ec_inputs_brushed_half_vector, 19, BIT(14), 0, 6, {EACH("lambda", 0, 1)}},
    {"coat_over", "coat_over", "coat.h", ec_inputs_opaque, 15, BIT(14), 0, 32, {EACH("f cos", 0, 1), EACH("pdf", 1, 1)}},
    {"sheen_over", "sheen_over", "sheen.h", ec_inputs_opaque, 15, BIT(14), 0, 60, {EACH("f cos", 0, 3), EACH("pdf", 3, 1), EACH("E", 4, 1)}},
    {"multiscatter_over, metal", "multiscatter_over", "multiscatter.h", ec_inputs_opaque, 15, BIT(14), 0, 40, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"multiscatter_over, glass", "multiscatter_over", "multiscatter.h", ec_inputs_into_glass, 15, 0, 0, 60, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval_diffuse_transmission", "bsdf_eval_diffuse_transmission", "bsdf.h", ec_inputs_thin, 15, BIT(14), 0, 24, {SCALED("f cos", 0, 4)}},
    {"dispersed_index", "dispersed_index", "dispersion.h", ec_inputs_dispersion, 2, 0, 0, 6, {EACH("n_C, n_F", 0, 2)}},
    {"film_reflectance", "film_reflectance", "iridescence.h", ec_inputs_film, 6, BIT(5), 0, 60, {SCALED("F", 0, 3)}},
    {"bsdf_eval, opaque", "bsdf_eval", "bsdf.h", ec_inputs_opaque, 15, BIT(14), 0, 24, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval, into glass", "bsdf_eval", "bsdf.h", ec_inputs_into_glass, 15, 0, 0, 40, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval, off glass", "bsdf_eval", "bsdf.h", ec_inputs_off_glass, 15, 0, 0, 40, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval, thin wall", "bsdf_eval", "bsdf.h", ec_inputs_thin, 15, BIT(14), 0, 40, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval, into brushed glass", "bsdf_eval", "bsdf.h", ec_inputs_into_brushed_glass, 19, 0, 0, 52, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"bsdf_eval, off brushed glass", "bsdf_eval", "bsdf.h", ec_inputs_off_brushed_glass, 19, 0, 0, 52, {EACH("f cos", 0, 3), EACH("pdf", 3, 1)}},
    {"ggx_sample", "ggx_sample", "ggx.h", ec_inputs_opaque, 18, BIT(14), BIT(15), 24, {EACH("m", 0, 3)}},
    {"bsdf_sample, opaque", "bsdf_sample", "bsdf.h", ec_inputs_opaque, 18, BIT(14), BIT(15), 60, {VECTOR("wi", 0), EACH("f cos / pdf", 3, 3)}},
    {"bsdf_sample, glass", "bsdf_sample", "bsdf.h", ec_inputs_off_glass, 18, 0, BIT(15), 90, {VECTOR("wi", 0), EACH("f cos / pdf", 3, 3)}},
    {"bsdf_sample, brushed glass", "bsdf_sample", "bsdf.h", ec_inputs_off_brushed_glass, 19, 0, BIT(15), 90, {VECTOR("wi", 0), EACH("f cos / pdf", 3, 3)}},
    {"bsdf_sample, smooth glass", "bsdf_sample", "bsdf.h", ec_inputs_smooth_glass, 18, BIT(12), BIT(15), 30, {VECTOR("wi", 0), EACH("f cos / pdf", 3, 3)}},
    {"blind_sample", "blind_sample", "bsdf.h", ec_inputs_off_glass, 18, 0, BIT(15), 8, {EACH("wi", 0, 3)}},
    {"blinn_phong_eval", "blinn_phong_eval", "blinn_phong.h", ec_inputs_highlight, 15, BIT(14), 0, 24, {EACH("f cos", 0, 3)}},

    {"interpolate", "interpolate", "geometry.h", ec_inputs_values, 11, 0, 0, 5, {EACH("value", 0, 1)}},
    {"surface_place", "surface_place", "surface.h", ec_inputs_hit, 30, 0, 0, 9, {VECTOR("p", 0), VECTOR("error bound", 3), VECTOR("ng", 6)}},
    {"surface_offset", "surface_offset", "surface.h", ec_inputs_offset, 12, 0, 0, 5, {EACH("origin", 0, 3)}},
    {"surface_tangent", "surface_tangent", "surface.h", ec_inputs_hit, 30, 0, 0, 5, {VECTOR("dp/du", 0)}},
    {"surface_frame", "surface_frame", "surface.h", ec_inputs_hit, 30, 0, 0, 24, {VECTOR("ns", 0), VECTOR("s", 3), VECTOR("t", 6)}},
    {"surface_frame, normal map", "surface_frame", "surface.h", ec_inputs_mapped_hit, 30, 0, 0, 40, {VECTOR("ns", 0), VECTOR("s", 3), VECTOR("t", 6)}},
    {"surface_to_local", "surface_to_local", "surface.h", ec_inputs_two_directions, 6, 0, 0, 12, {VECTOR("local", 0), VECTOR("and back", 3)}},
    {"medium_transmittance", "medium_transmittance", "medium.h", ec_inputs_distance, 19, 0, 0, 5, {EACH("T", 0, 3)}},

    {"phase_value", "phase_value", "scatter.h", ec_inputs_phase, 7, 0, 0, 24, {EACH("p", 0, 1)}},
    {"phase_sample", "phase_sample", "scatter.h", ec_inputs_phase, 9, 0, BIT(7), 40, {VECTOR("wi", 0)}},
    {"scatter_distance", "scatter_distance", "scatter.h", ec_inputs_free_way, 2, BIT(1), 0, 8, {EACH("t", 0, 1)}},
    {"fog_span", "fog_span", "scatter.h", ec_inputs_fog, 7, 0, 0, 16, {SCALED("from, span", 0, 2)}},

    {"slab_near", "slab", "ray.h", ec_inputs_box, 12, 0, 0, 8, {EACH("near, far", 0, 2)}},
    {"edges_distance", "triangle", "ray.h", ec_inputs_triangle, 15, 0, 0, 16, {STATED("t", 0, 1), SCALED("b1, b2", 2, 2)}},

    {"light_sample_triangle", "light_sample_triangle", "light.h", ec_inputs_light, 21, BIT(15) | BIT(16), 0, 32,
     {STATED("wi", 0, 3), VECTOR("towards", 4), EACH("pdf", 7, 1), VECTOR("normal", 8)}}, /* the bound of the end is relative to the longest axis: no
                                                                                           * digits at ties */
    {"light_from_centre", "light_from_centre", "light_centre.h", ec_inputs_light, 21, BIT(15) | BIT(16), 0, 32, {EACH("irradiance", 0, 3)}},
    {"light_sample_punctual", "light_sample_punctual", "light.h", ec_inputs_spot, 19, BIT(15) | BIT(16), 0, 16, {VECTOR("wi", 0), EACH("irradiance", 3, 3)}},
    {"environment_uv", "environment_uv", "environment.h", ec_inputs_direction, 3, 0, 0, 12, {SCALED("u", 0, 1), EACH("v", 2, 1)}},
    {"patch_across, patch_along", "patch", "patch.h", ec_inputs_patch, 5, 0, 0, 24, {SCALED("across", 0, 1), SCALED("along", 2, 1)}},
    {"environment_look_up", "environment_look_up", "environment.h", ec_inputs_direction, 3, 0, 0, 32, {VECTOR("radiance", 0), EACH("pdf", 3, 1)}},
    {"environment_sample", "environment_sample", "environment.h", ec_inputs_sample, 2, BIT(0) | BIT(1), 0, 32, {VECTOR("wi", 0), VECTOR("radiance", 3), EACH("pdf", 6, 1)}},
    {"environment_sample, constant", "environment_sample_constant", "environment.h", ec_inputs_sample, 2, BIT(0) | BIT(1), 0, 8, {EACH("wi", 0, 3)}},

    {"texture_sample", "texture_sample", "texture.h", ec_inputs_texture, 3, BIT(0), 0, 8, {VECTOR("rgb", 0)}},
    {"camera_sample", "camera_sample", "camera.h", ec_inputs_slot, 1, BIT(0), 0, 4, {SCALED("place in the picture", 0, 2)}},
    {"raster_edge", "raster_edge", "raster.h", ec_inputs_edge, 15, 0, 0, 6, {VECTOR("edge function", 0)}},
    {NULL, NULL, NULL, NULL, 0, 0, 0, 0, {{NULL, 0, 0, EC_PRECISION_EACH}}},
};

static void put_texture(float *memory, uint32_t id, uint32_t wrap)
{
    float *row = memory + EC_PRECISION_TEXTURES + 4 * id;
    row[0] = ec_float_of_bits(0);
    row[1] = row[2] = ec_float_of_bits(EC_PRECISION_TEXTURE_SIZE);
    row[3] = ec_float_of_bits(EC_TEXTURE_FLOAT | wrap | wrap << EC_TEXTURE_WRAP_T);
}

static void put_material(float *memory, uint32_t id, int32_t normal_map)
{
    float *material = memory + EC_PRECISION_MATERIALS + EC_MATERIAL_WORDS * id;
    for (uint32_t slot = 0; slot < EC_SLOT_COUNT; slot++) {
        float *s = material + EC_WORD_slots + 8 * slot;
        s[0] = ec_float_of_bits((uint32_t)(slot == EC_SLOT_NORMAL ? normal_map : -1));
        s[2] = s[6] = 1; /* (u, v) unchanged */
    }
    material[EC_WORD_normal_scale] = 1;
}

static void put_even_table(float *entries, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        entries[2 * i] = ec_float_of_bits((uint32_t)(((uint64_t)i << 32) / n));
        entries[2 * i + 1] = ec_float_of_bits(i);
    }
}

void ec_precision_fill(float *memory, ec_params *params)
{
    uint64_t random = 1;
    const uint32_t rows = EC_PRECISION_MAP_HEIGHT + 1, texels = EC_PRECISION_MAP_WIDTH * rows;
    for (uint32_t i = 0; i < texels; i++) {
        for (int k = 0; k < 3; k++) memory[EC_PRECISION_MAP + 4 * i + k] = (float)ec_random_between(&random, 1, 2);
        memory[EC_PRECISION_MAP + 4 * i + 3] = 1.0f / (float)texels; /* equal, so that the density has no jumps between texels */
    }
    put_even_table(memory + EC_PRECISION_TABLE, rows);
    for (uint32_t y = 0; y < rows; y++)
        put_even_table(memory + EC_PRECISION_TABLE + 2 * (rows + y * EC_PRECISION_MAP_WIDTH), EC_PRECISION_MAP_WIDTH);
    for (uint32_t id = 0; id < 3; id++) put_texture(memory, id, id);
    for (uint32_t i = 0; i < 4 * EC_PRECISION_TEXTURE_SIZE * EC_PRECISION_TEXTURE_SIZE; i++) {
        double is_z = i % 4 == 2; /* the z of a normal map of moderate slopes */
        memory[EC_PRECISION_TEXELS + i] = (float)(is_z ? ec_random_between(&random, 0.9, 1) : ec_random_between(&random, 0.2, 0.8));
    }
    put_material(memory, 0, -1);
    put_material(memory, 1, 0);
    *params = (ec_params){.scene_radius = 10, .width = 4096, .height = 4096, .batch = 1, .environment = {1, 1, 1, 0}, .environment_pmf = 1,
                          .environment_width = EC_PRECISION_MAP_WIDTH, .environment_height = EC_PRECISION_MAP_HEIGHT};
}
