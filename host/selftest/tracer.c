#include "selftest/tracer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "shared/params.h"

enum { LOCAL = 64, BRUTE_FORCE_MOST = 64 };

static ec_result build_programs(ec_tracer *r, ec_error *err)
{
    char name[64], options[64];
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!(r->used >> a & 1)) continue;
        r->lanes[a] = ec_accels[a].lanes ? 1 : r->t->lanes;
        snprintf(name, sizeof name, "traverse_%s", ec_accels[a].name);
        snprintf(options, sizeof options, "-DFEATURES=0x0u -DPROBE -DLANES=%u", ec_accels[a].lanes ? ec_accels[a].lanes : r->t->lanes);
        EC_TRY(ec_program_build(r->t->cl, name, ec_kernel_source(name), options, &r->programs[a], err));
    }
    return EC_OK;
}

static ec_result open_tracer(ec_tracer *r, ec_error *err)
{
    r->used = (1u << EC_ACCEL_COUNT) - 1;
    if (!r->t->full) EC_TRY(ec_accels_choose(NULL, 1000, r->t->cl->info.type & CL_DEVICE_TYPE_CPU, &r->used, err));
    r->paths = calloc((size_t)EC_PATH_FIELDS * EC_TRACER_RAYS, sizeof *r->paths);
    r->hits = calloc((size_t)EC_HIT_PROBE_FIELDS * EC_TRACER_RAYS, sizeof *r->hits);
    if (!r->paths || !r->hits) return ec_fail(err, "out of memory for %u rays", EC_TRACER_RAYS);
    return build_programs(r, err);
}

ec_result ec_tracer_of(ec_selftest *t, ec_tracer **tracer, ec_error *err)
{
    *tracer = t->tracer;
    if (t->tracer) return EC_OK;
    ec_tracer *r = calloc(1, sizeof *r);
    if (!r) return ec_fail(err, "out of memory for rays");
    r->t = t;
    if (open_tracer(r, err) != EC_OK) {
        ec_tracer_close(r);
        return EC_FAILED;
    }
    *tracer = t->tracer = r;
    return EC_OK;
}

static void free_accels(ec_tracer *r)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) ec_accel_free(&r->accels[a]);
}

void ec_tracer_close(ec_tracer *r)
{
    if (!r) return;
    free_accels(r);
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (r->programs[a]) clReleaseProgram(r->programs[a]);
    free(r->paths);
    free(r->hits);
    free(r);
}

ec_result ec_tracer_build(ec_tracer *r, const ec_soup *soup, ec_error *err)
{
    free_accels(r);
    memset(r->hits, 0, (size_t)EC_HIT_PROBE_FIELDS * EC_TRACER_RAYS * sizeof *r->hits); /* no triangle of another soup remains */
    r->soup = soup;
    r->largest = ec_soup_largest(soup);
    EC_FREED uint32_t *indices = malloc((3 * (size_t)soup->count + 1) * sizeof *indices);
    if (!indices) return ec_fail(err, "out of memory for %u triangles", soup->count);
    for (uint32_t i = 0; i < 3 * soup->count; i++) indices[i] = i;
    ec_result result = EC_OK;
    ec_accel_input input = {.positions = soup->vertices, .indices = indices, .triangle_count = soup->count};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT && result == EC_OK; a++)
        if (r->used >> a & 1 && (strcmp(ec_accels[a].name, "none") || soup->count <= BRUTE_FORCE_MOST))
            result = ec_accel_build(a, &input, &r->accels[a], err);
    ec_accel_input_free(&input);
    return result;
}

bool ec_tracer_has(const ec_tracer *r, uint32_t accel) { return r->accels[accel].buffers[0].data; }

void ec_tracer_ray(ec_tracer *r, uint32_t i, const float o[3], const float d[3], uint32_t skip)
{
    for (size_t k = 0; k < 3; k++) {
        r->paths[(EC_PATH_OX + k) * EC_TRACER_RAYS + i] = o[k];
        r->paths[(EC_PATH_DX + k) * EC_TRACER_RAYS + i] = d[k];
    }
    memcpy(&r->paths[(size_t)EC_PATH_PRIM * EC_TRACER_RAYS + i], &skip, sizeof skip);
}

void ec_tracer_given(const ec_tracer *r, uint32_t i, float o[3], float d[3])
{
    for (size_t k = 0; k < 3; k++) {
        o[k] = r->paths[(EC_PATH_OX + k) * EC_TRACER_RAYS + i];
        d[k] = r->paths[(EC_PATH_DX + k) * EC_TRACER_RAYS + i];
    }
}

enum { BUFFERS_AT = 10, ARGUMENTS = 27 }; /* positions in traverse_NAME's kernel: the structure's buffers; arguments behind them are not used here */

ec_result ec_tracer_trace(ec_tracer *r, uint32_t a, uint32_t count, ec_error *err)
{
    const ec_accel *accel = &r->accels[a];
    uint32_t zero = 0, wave = EC_TRACER_RAYS;
    char name[64];
    ec_params params = {.wave = wave, .part = wave, .batch = 1, .width = 1, .height = 1, .scene_max = r->largest};
    ec_counters counters = {.at = {{.rays = {count}}}};
    ec_array arrays[ARGUMENTS] = {EC_IN(&params, 1), EC_SCALAR(zero), EC_SCALAR(zero), [4] = EC_SCALAR(zero), EC_SCALAR(zero), EC_IN(&counters, 1),
                                  EC_SCALAR(zero), EC_IN(r->paths, EC_PATH_FIELDS * wave), EC_OUT(r->hits, EC_HIT_PROBE_FIELDS * wave)};
    for (uint32_t k = 0; k < EC_ACCEL_BUFFERS; k++)
        if (accel->buffers[k].data) arrays[BUFFERS_AT + k] = (ec_array){accel->buffers[k].data, accel->buffers[k].bytes, EC_ARRAY_IN};
    snprintf(name, sizeof name, "ec_intersect_%s", ec_accels[a].name);
    return ec_kernel_call(r->t->cl, r->programs[a], name,
                          (count + r->lanes[a] - 1) / r->lanes[a], LOCAL, arrays, ARGUMENTS, err);
}

bool ec_tracer_next(ec_tracer *r, uint32_t *a, uint32_t count, ec_result *result, ec_error *err)
{
    while (*a < EC_ACCEL_COUNT && !ec_tracer_has(r, *a)) (*a)++;
    if (*a == EC_ACCEL_COUNT || *result != EC_OK) return false;
    *result = ec_tracer_trace(r, *a, count, err);
    return *result == EC_OK;
}

ec_traced ec_tracer_hit(const ec_tracer *r, uint32_t i)
{
    ec_traced h = {.b1 = r->hits[EC_HIT_B1 * EC_TRACER_RAYS + i], .b2 = r->hits[EC_HIT_B2 * EC_TRACER_RAYS + i],
                   .t = r->hits[EC_HIT_T * EC_TRACER_RAYS + i]};
    memcpy(&h.prim, &r->hits[i], sizeof h.prim);
    return h;
}

void ec_float_direction(const double from[3], const double to[3], float d[3])
{
    double way[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, length = sqrt(ec_dot(way, way));
    for (int k = 0; k < 3; k++) d[k] = (float)(length > 0 ? way[k] / length : k == 2);
}
