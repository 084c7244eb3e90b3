#include "device/probe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/random.h"
#include "device/pipeline.h"

#define RUNS 4 /* the first may compile; the best of the others counts */

static const float *vertex(const ec_scene *scene, uint32_t triangle, int corner)
{
    return scene->positions + 3 * (size_t)scene->indices[3 * (size_t)triangle + (uint32_t)corner];
}

/* Areas up to and including each triangle's, doubled. */
static double *sum_areas(const ec_scene *scene)
{
    double *sums = malloc((scene->triangle_count + (size_t)1) * sizeof *sums), sum = 0.0;
    for (uint32_t i = 0; sums && i < scene->triangle_count; i++) {
        const float *a = vertex(scene, i, 0), *b = vertex(scene, i, 1), *c = vertex(scene, i, 2);
        double e[3], f[3];
        for (int k = 0; k < 3; k++) e[k] = (double)b[k] - a[k], f[k] = (double)c[k] - a[k];
        sums[i] = sum += hypot(hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2]), e[0] * f[1] - e[1] * f[0]);
    }
    return sums;
}

static void make_ray(const ec_scene *scene, const double *areas, uint64_t *state, float *queue, uint32_t i)
{
    uint32_t low = 0, high = scene->triangle_count - 1;
    for (double at = ec_random_unit(state) * areas[high]; low < high;) {
        uint32_t middle = low + (high - low) / 2;
        if (areas[middle] < at) low = middle + 1;
        else high = middle;
    }
    double root = sqrt(ec_random_unit(state)), v = ec_random_unit(state) * root, z = 2.0 * ec_random_unit(state) - 1.0;
    double angle = 6.283185307179586 * ec_random_unit(state), r = sqrt(fmax(0.0, 1.0 - z * z));
    const double direction[3] = {r * cos(angle), r * sin(angle), z};
    const float *a = vertex(scene, low, 0), *b = vertex(scene, low, 1), *c = vertex(scene, low, 2);
    for (uint32_t k = 0; k < 3; k++) {
        queue[(EC_PATH_OX + k) * EC_PROBE_RAYS + i] = (float)((1.0 - root) * a[k] + (root - v) * b[k] + v * c[k]);
        queue[(EC_PATH_DX + k) * EC_PROBE_RAYS + i] = (float)direction[k];
    }
    memcpy(&queue[EC_PATH_PRIM * EC_PROBE_RAYS + i], &low, sizeof low);
}

static ec_result make_rays(ec_pipeline *p, const ec_scene *scene, ec_error *err)
{
    uint64_t state = 1;
    double *areas = sum_areas(scene);
    float *queue = calloc(EC_PATH_FIELDS * EC_PROBE_RAYS, sizeof *queue);
    ec_result result = areas && queue ? EC_OK : ec_fail(err, "out of memory for %u rays", EC_PROBE_RAYS);
    for (uint32_t i = 0; result == EC_OK && i < EC_PROBE_RAYS; i++) make_ray(scene, areas, &state, queue, i);
    if (result == EC_OK)
        result = ec_buffer_create(p->cl, "rays", EC_PATH_FIELDS * EC_PROBE_RAYS * 4, queue, &p->path_queues[0], err);
    p->buffers[EC_ARG_PATHS] = p->path_queues[0];
    free(areas);
    free(queue);
    return result;
}

static ec_result make_buffers(ec_pipeline *p, const ec_scene *scene, ec_error *err)
{
    ec_counters counters = {0};
    for (uint32_t k = 0; k < EC_PARTS; k++) counters.at[0].rays[k * EC_PART_STRIDE] = EC_PROBE_RAYS / EC_PARTS;
    p->params = (ec_params){.width = 1, .height = 1, .batch = 1, .wave = EC_PROBE_RAYS, .part = EC_PROBE_RAYS / EC_PARTS};
    for (size_t i = 0; i < 3 * (size_t)scene->vertex_count; i++)
        p->params.scene_max = fmaxf(p->params.scene_max, fabsf(scene->positions[i]));
    p->wave = EC_PROBE_RAYS;
    EC_TRY(make_rays(p, scene, err));
    EC_TRY(ec_buffer_create(p->cl, "hits", EC_HIT_PROBE_FIELDS * EC_PROBE_RAYS * 4 + 64, NULL, &p->buffers[EC_ARG_HITS], err));
    EC_TRY(ec_buffer_create(p->cl, "counters", sizeof counters, &counters, &p->buffers[EC_ARG_COUNTERS], err));
    return ec_buffer_create(p->cl, "parameters", sizeof p->params, &p->params, &p->buffers[EC_ARG_PARAMS], err);
}

/* A packet counts for each of its rays what the whole packet does, so counts come from kernels of one lane. */
static ec_result build(ec_pipeline *p, uint32_t which, bool count, ec_error *err)
{
    char unit[64], options[64], name[64];
    const ec_traversal way = ec_traversal_of(&p->cl->info, which, p->accels[which].bytes, 0, count ? 1 : p->lanes);
    ec_bound_kernel *kernel = &p->kernels.traverse[which][0];
    p->kernels.lanes = count ? 1 : p->lanes;
    cl_program *program = &p->kernels.programs[count ? 0 : way.lanes];
    if (kernel->kernel) clReleaseKernel(kernel->kernel);
    *kernel = (ec_bound_kernel){.takes = way.takes};
    snprintf(unit, sizeof unit, "traverse_%s", ec_accels[which].name);
    snprintf(name, sizeof name, "ec_intersect_%s", ec_accels[which].name);
    snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x0u%s%s", way.lanes, way.options, count ? " -DPROBE" : "");
    EC_TRY(ec_program_build(p->cl, unit, ec_kernel_source(unit), options, program, err));
    return ec_kernel_create(*program, name, &kernel->kernel, err);
}

static ec_result count(ec_pipeline *p, uint32_t which, ec_accel_probe *probe, ec_error *err)
{
    const uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_BOUNCE] = 1, [EC_ARG_SORTS] = 1};
    uint32_t *counts = malloc(2 * EC_PROBE_RAYS * sizeof *counts);
    uint64_t sums[2] = {0};
    if (!counts) return ec_fail(err, "out of memory for %u rays", EC_PROBE_RAYS);
    ec_result result = build(p, which, true, err);
    if (result == EC_OK) result = ec_pipeline_launch_trace(p, 0, which, scalars, err);
    if (result == EC_OK)
        result = ec_buffer_read(p->cl, p->buffers[EC_ARG_HITS], (uint64_t)EC_HIT_NODES * EC_PROBE_RAYS * 4,
                                2 * EC_PROBE_RAYS * 4, counts, err);
    for (uint32_t i = 0; result == EC_OK && i < 2 * EC_PROBE_RAYS; i++) sums[i / EC_PROBE_RAYS] += counts[i];
    probe->nodes = (double)sums[0] / EC_PROBE_RAYS;
    probe->triangles = (double)sums[1] / EC_PROBE_RAYS;
    free(counts);
    return result;
}

static ec_result measure(ec_pipeline *p, uint32_t which, ec_accel_probe *probe, ec_error *err)
{
    const uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_BOUNCE] = 1, [EC_ARG_SORTS] = 1};
    EC_TRY(build(p, which, false, err));
    for (int run = 0; run < RUNS; run++) {
        EC_TRY(ec_cl_finish(p->cl, err));
        double start = ec_now();
        EC_TRY(ec_pipeline_launch_trace(p, 0, which, scalars, err));
        EC_TRY(ec_cl_finish(p->cl, err));
        if (run) probe->rays_per_second = fmax(probe->rays_per_second, EC_PROBE_RAYS / (ec_now() - start));
    }
    return EC_OK;
}

/* scene: where rays start; built: what the accelerator is built of. */
static ec_result probe_one(ec_cl *cl, const ec_scene *scene, const ec_scene *built, uint32_t which, float grid_density,
                           ec_accel_probe *probe, ec_error *err)
{
    ec_pipeline p = {.cl = cl, .compiler = {.report = -1}};
    EC_TRY(ec_pipeline_lanes(cl, 0, &p.lanes, err));
    ec_accel_input input = ec_accel_input_of(built, grid_density);
    memset(probe, 0, sizeof *probe);
    ec_payload payload = {0};
    p.accels[which].in_use = true;
    ec_result result = ec_payload_add_accel(&payload, which, &input, &probe->build, err);
    ec_accel_input_free(&input);
    if (result == EC_OK) result = ec_pipeline_upload(&p, &payload, &payload, err);
    if (result == EC_OK && scene->triangle_count) {
        result = make_buffers(&p, scene, err);
        if (result == EC_OK) result = count(&p, which, probe, err);
        if (result == EC_OK) result = measure(&p, which, probe, err);
    }
    ec_pipeline_destroy(&p);
    return result;
}

/* Rays start on surfaces, which instances have only once they are written out. */
ec_result ec_probe_accel(ec_cl *cl, const ec_scene *scene, uint32_t which, float grid_density, ec_accel_probe *probe, ec_error *err)
{
    if (!scene->placed_count) return probe_one(cl, scene, scene, which, grid_density, probe, err);
    ec_scene written;
    EC_TRY(ec_scene_write_out(scene, &written, err));
    ec_result result =
        probe_one(cl, &written, which == ec_accel_find("twolevel") ? scene : &written, which, grid_density, probe, err);
    ec_scene_written_free(&written);
    return result;
}
