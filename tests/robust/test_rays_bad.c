/* tier: full */
/* Contents of files that make no surface: triangles without area or with invalid numbers, nodes that flatten, normals and tangents of
 * zeros. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "robust/cases.h"
#include "gltf/model.h"
#include "selftest/shot.h"
#include "selftest/tracer.h"

enum { FLAT = 4, NEVER_MET = FLAT - 1, ODD = 4, BAD = FLAT + ODD };
static const float bad[BAD][9] = {
    {0, 0, 0, 0, 0, 0, 0, 0, 0},                         /* a point */
    {0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f, 1, 0, 0},       /* two equal corners */
    {1e-30f, 0, 0, 0, 1e-30f, 0, 0, 0, 1e-30f},          /* an area beyond float's range */
    {0, 0, 0, 1, 1, 1, 2, 2, 2},                         /* corners on a line */
    {NAN, 0, 0, 1, 0, 0, 0, 1, 0},
    {0, INFINITY, 0, 1, 0, 0, 0, 1, 0},
    {0, 0, 0, 1, 0, -INFINITY, 0, NAN, 0},
    {FLT_MAX, 0, 0, 0, FLT_MAX, 0, 0, 0, FLT_MAX},       /* squared distances overflow */
};

/* Surrounds them with a lit box, so that there is something to render. */
static ec_result spoilt_box(ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material walls = ec_material_lambert(0.5, 1);
        int32_t material = ec_model_material(m, &walls);
        for (int i = 0; i < BAD; i++) ec_model_add(m, material, &(ec_model_mesh){.vertex_count = 3, .index_count = 3, .positions = bad[i],
                                                                              .indices = (const uint32_t[3]){0, 1, 2}});
        ec_model_box(m, material, (double[3]){-1, -1, -1}, (double[3]){1, 1, 1}, true);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.1, 0.2, 0.3}, (double[3]){1, 0.4, -0.5}, 1);
    }
    return ec_model_scene(m, scene, err);
}

/* If the loader lets one pass, no accelerator may crash or hit it. (Three corners on a line can be hit, since rounding moves them apart.
 * That is why the loader checks.) */
static ec_result trace_flat(ec_selftest *t, uint64_t *hits, uint64_t *rays, ec_error *err)
{
    uint64_t random = 10;
    ec_tracer *r;
    ec_soup soup;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_make(NEVER_MET, &soup, err));
    memcpy(soup.vertices, bad, sizeof bad[0] * NEVER_MET);
    ec_result result = ec_tracer_build(r, &soup, err);
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
        const float *v = soup.vertices + 9 * (i % NEVER_MET);
        double from[3], to[3], along = i % 3 ? ec_random_unit(&random) : 0;
        float o[3], d[3];
        for (int k = 0; k < 3; k++) {
            o[k] = (float)ec_random_between(&random, -3, 3);
            from[k] = o[k];
            to[k] = v[k] + along * ((double)v[6 + k] - v[k]);
        }
        ec_float_direction(from, to, d);
        ec_tracer_ray(r, i, o, d, EC_NO_ID);
    }
    for (uint32_t a = 0; ec_tracer_next(r, &a, EC_TRACER_RAYS, &result, err); a++) {
        for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) *hits += ec_tracer_hit(r, i).prim != EC_NO_ID;
        *rays += EC_TRACER_RAYS;
    }
    ec_soup_free(&soup);
    return result;
}

static ec_result degenerate_case(ec_selftest *t, ec_error *err)
{
    ec_scene *scene;
    uint64_t hits = 0, rays = 0;
    ec_render_options o = ec_shot_options(t, 8, 64);
    EC_TRY(spoilt_box(&scene, err));
    ec_result result = ec_selftest_value(t, "dropped for want of area", FLAT, scene->dropped_degenerate, 0, 0, err);
    if (result == EC_OK) result = ec_selftest_value(t, "dropped for NaN or infinity", ODD, scene->dropped_nonfinite, 0, 0, err);
    if (result == EC_OK) result = ec_shot_row(t, "radiance beside them", scene, &o, 2, err); /* 1 / (1 - albedo) */
    ec_scene_free(scene);
    if (result == EC_OK) result = trace_flat(t, &hits, &rays, err);
    EC_TRY(result);
    return ec_selftest_none(t, "hit", hits, rays, NULL, err);
}

/* A smooth ball in an emitting box, below a node whose matrix has this rank. Two dimensions make a disc, which reflects as it should; fewer
 * leave no area. */
static ec_result flattened(int rank, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material walls = ec_material_lambert(0.5, 1), disc = ec_material_lambert(0.5, 1);
        const double matrix[16] = {rank > 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, rank > 1, 0, 0.1, -0.3, 0.2, 1};
        ec_model_box(m, ec_model_material(m, &walls), (double[3]){-1, -1, -1}, (double[3]){1, 1, 1}, true);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.1, 0.7, 0.3}, (double[3]){0.1, -0.3, 0.2}, 1);
        disc.double_sided = true;
        ec_model_place(m, matrix);
        ec_model_sphere(m, ec_model_material(m, &disc), (double[3]){0, 0, 0}, 0.4, 2, true);
    }
    return ec_model_scene(m, scene, err);
}

static ec_result singular_nodes_case(ec_selftest *t, ec_error *err)
{
    static const char *const names[3] = {"a point", "a line", "a disc"};
    ec_render_options o = ec_shot_options(t, 8, 8192);
    for (int rank = 0; rank < 3; rank++) {
        ec_scene *scene;
        EC_TRY(flattened(rank, &scene, err));
        EC_TRY(ec_shot_only_row(t, names[rank], scene, &o, 2, err));
    }
    return EC_OK;
}

/* A texture of one texel. */
static ec_result add_texture(ec_scene *scene, const uint8_t texel[4], ec_error *err)
{
    scene->images = calloc(1, sizeof *scene->images);
    scene->textures = calloc(1, sizeof *scene->textures);
    if (!scene->images || !scene->textures || !(scene->images[0].rgba8 = malloc(4)))
        return ec_fail(err, "out of memory for a texel");
    scene->image_count = scene->texture_count = 1;
    scene->images[0].width = scene->images[0].height = 1;
    memcpy(scene->images[0].rgba8, texel, 4);
    return EC_OK;
}

/* Triangles with given normals, tangents and texture coordinates: a closed emitting box. */
static ec_result box_of(const float normals[9], const float tangents[12], const float uv[6], const uint8_t *texel,
                        ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material walls = ec_material_lambert(0.5, 1);
        int32_t material = ec_model_material(m, &walls);
        static const float corners[4][3] = {{-1, -1, -1}, {3, -1, -1}, {-1, 3, -1}, {-1, -1, 3}};
        static const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}; /* of a tetrahedron, seen from inside */
        for (int i = 0; i < 4; i++) {
            float positions[9];
            for (int k = 0; k < 9; k++) positions[k] = corners[faces[i][k / 3]][k % 3];
            ec_model_add(m, material, &(ec_model_mesh){.vertex_count = 3, .positions = positions, .normals = normals,
                                                       .tangents = tangents, .uv = uv});
        }
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){-0.3, -0.2, -0.1}, (double[3]){1, -0.4, -0.7}, 0.9);
    }
    EC_TRY(ec_model_scene(m, scene, err));
    if (!texel) return EC_OK;
    (*scene)->materials[0].textures[EC_SLOT_NORMAL].texture = 0;
    return add_texture(*scene, texel, err);
}

/* A meaningless normal or tangent is replaced by the geometric one, and the closed box gives 1 / (1 - albedo) as usual. A map of (128,
 * 128, 128) has a nearly zero normal: only that the result is a number is promised. */
static ec_result zero_normals_case(ec_selftest *t, ec_error *err)
{
    static const float zeros[12] = {0}, uv[6] = {0, 0, 1, 0, 0, 1}, up[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const uint8_t flat[4] = {128, 128, 255, 255}, none[4] = {128, 128, 128, 255}, back[4] = {128, 128, 0, 255},
                         black[4] = {0};
    const struct {
        const char *name;
        const float *normals, *tangents, *uv;
        const uint8_t *texel;
        bool is_exact;
    } boxes[] = {
        {"normals of zeros", zeros, NULL, NULL, NULL, true},
        {"tangents of zeros", zeros, zeros, uv, flat, false},
        {"texture coordinates of zeros", zeros, zeros, zeros, flat, true},
        {"a map without a direction", zeros, NULL, uv, none, false},
        {"a map that looks back", zeros, NULL, uv, back, false},
        {"a black map", up, zeros, uv, black, false},
    };
    uint64_t invalid = 0, samples = 0;
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        ec_scene *scene;
        ec_shot shot = {0};
        ec_render_options o = ec_shot_options(t, 8, 64);
        ec_result result = box_of(boxes[i].normals, boxes[i].tangents, boxes[i].uv, boxes[i].texel, &scene, err);
        if (result == EC_OK) result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        invalid += shot.stats.invalid_samples + shot.film.invalid_count;
        samples += shot.stats.samples;
        if (boxes[i].is_exact)
            result = ec_selftest_value(t, boxes[i].name, 2, shot.mean, shot.noise, fmin(4 * shot.noise, 0.04) + 2e-5, err);
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return ec_selftest_none(t, "samples that are no numbers", invalid, samples, NULL, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/degenerate", false, degenerate_case, "triangles without area or numbers that crash builders or shine"},
        {"rays/singular nodes", false, singular_nodes_case, "NaN normals below nodes that flatten"},
        {"rays/zero normals", false, zero_normals_case, "NaN from normals, tangents and normal maps of zeros"},
    };
    return RUN_CASES(cases);
}
