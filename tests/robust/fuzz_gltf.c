/* Fuzzes .gltf and .glb files, from bytes to the buffers of kernels: loading, checking, packing, building every structure. */
#include <math.h>

#include "accel/accel.h"
#include "../support/bvh_check.h"
#include "fuzz.h"
#include "pack/pack.h"
#include "scene/validate.h"
#include "gltf/reader.h"

enum { TRIANGLES_MOST = 4000 }; /* larger pictures find nothing more and are slower */

static void keep_one_line(void *user, ec_severity severity, const char *text)
{
    (void)user, (void)severity;
    PROMISE(!strchr(text, '\n'), "more than a line: %s", text);
}

static void judge_lights(const ec_pack *pack)
{
    double sum = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) {
        const ec_light_data *l = &pack->lights[i];
        PROMISE(l->pmf >= 0 && l->pmf <= 1 && isfinite(l->pdf_a), "light %u: pmf %g, pdf_a %g", i, l->pmf, l->pdf_a);
        PROMISE(pack->light_shares[i].guide < pack->light_count, "light %u: guide %u", i, pack->light_shares[i].guide);
        sum += l->pmf;
    }
    PROMISE(!pack->light_count || fabs(sum - 1) < 1e-5, "the chances of %u lights add up to %g", pack->light_count, sum);
}

static void judge_environment(const ec_environment *e)
{
    uint64_t count = e->rgb ? 3 * (uint64_t)e->width * e->height : 3;
    const float *values = e->rgb ? e->rgb : e->constant;
    for (uint64_t i = 0; i < count; i++) PROMISE(values[i] >= 0 && values[i] <= EC_RADIANCE_MOST, "environment: %g", values[i]);
    for (int i = 0; e->turned && i < 9; i++) PROMISE(fabsf(e->turn[i]) < 1.0001f, "environment turned by %g", e->turn[i]);
}

static void pack(const ec_scene *scene)
{
    ec_pack packed;
    ec_error err = {0};
    ec_result result = ec_pack_scene(scene, &packed, &err);
    fuzz_judge_result(result, &err);
    if (result != EC_OK) return;
    PROMISE(isfinite(packed.scene_radius) && isfinite(packed.scene_max), "radius %g", packed.scene_radius);
    judge_lights(&packed);
    judge_environment(&scene->environment);
    ec_pack_light_centres(scene, &packed, &err);
    fuzz_judge_result(EC_OK, &err);
    ec_pack_free(&packed);
}

static void build(const ec_scene *scene)
{
    ec_accel_input input = {.positions = scene->positions, .indices = scene->indices, .threads = 1,
                            .triangle_count = scene->triangle_count};
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        ec_accel accel;
        ec_error err = {0};
        ec_result result = ec_accel_build(which, &input, &accel, &err);
        fuzz_judge_result(result, &err);
        PROMISE(result == EC_OK, "%s: %s", ec_accels[which].name, err.text);
        ec_accel_free(&accel);
    }
    ec_error err = {0};
    if (input.bvh.nodes)
        PROMISE(bvh_check(&input.bvh, scene->positions, scene->indices, &err) == EC_OK, "%s", err.text);
    ec_accel_input_free(&input);
}

/* Returns the number of animations; 0 for a refused file. */
static uint32_t judge(const char *path, const ec_scene_choice *choice)
{
    ec_scene *scene = NULL;
    ec_error err = {0};
    ec_log log = {keep_one_line, NULL};
    ec_result result = ec_scene_load_choice(path, choice, &scene, &log, &err);
    fuzz_judge_result(result, &err);
    if (result != EC_OK) return 0;
    uint32_t animations = scene->contents.animations.count;
    PROMISE(ec_scene_validate(scene, &err) == EC_OK, "%s", err.text);
    if (scene->triangle_count <= TRIANGLES_MOST) {
        pack(scene);
        build(scene);
    }
    ec_scene_free(scene);
    return animations;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path = fuzz_file(data, size);
    if (judge(path, &(ec_scene_choice){0})) judge(path, &(ec_scene_choice){.animation = "all", .at = 0.6, .animated = true});
    return 0;
}
