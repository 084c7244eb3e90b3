#include "bench_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/bvh.h"
#include "shared/params.h"
#include "shared/path_state.h"

static const ec_stage_id stages[BENCH_TRACE_COUNT][2] = {{EC_INTERSECT_BVH8, EC_CONNECT_BVH8},
                                                         {EC_INTERSECT_PACKET, EC_CONNECT_PACKET}};

static ec_stage_id stage_of(bench_trace trace, bench_kind kind) { return stages[trace][kind == BENCH_SHADOW]; }

static ec_result upload_bvh(bench_device *d, const bench_mesh *mesh, bool with_packet, ec_error *err)
{
    ec_bvh bvh;
    ec_bvh_stats stats;
    ec_bvh8_node *wide;
    ec_tri8 *blocks;
    ec_bvh2_node *binary;
    ec_tri *triangles;
    ec_box *boxes;
    ec_box8 *wide_boxes;
    uint32_t nodes, leaves;
    EC_TRY(ec_bvh_build(mesh->positions, mesh->indices, mesh->triangle_count, 0, &bvh, &stats, err));
    EC_TRY(ec_bvh8_layout(&bvh, mesh->positions, mesh->indices, &wide, &nodes, &blocks, &wide_boxes, &leaves, err));
    EC_TRY(ec_buffer_create(&d->cl, "BVH8 nodes", (uint64_t)nodes * sizeof *wide, wide, &d->buffers[EC_ARG_BVH8_NODES], err));
    EC_TRY(ec_buffer_create(&d->cl, "BVH8 blocks", (uint64_t)leaves * sizeof *blocks, blocks, &d->buffers[EC_ARG_BVH8_BLOCKS], err));
    if (wide_boxes) EC_TRY(ec_buffer_create(&d->cl, "BVH8 boxes", (uint64_t)leaves * sizeof *wide_boxes, wide_boxes, &d->buffers[EC_ARG_BVH8_BOXES], err));
    free(wide);
    free(blocks);
    free(wide_boxes);
    if (with_packet) {
        EC_TRY(ec_bvh2_layout(&bvh, mesh->positions, mesh->indices, &binary, &nodes, &triangles, &boxes, &leaves, err));
        EC_TRY(ec_buffer_create(&d->cl, "BVH2 nodes", (uint64_t)nodes * sizeof *binary, binary, &d->buffers[EC_ARG_BVH2_NODES], err));
        EC_TRY(ec_buffer_create(&d->cl, "BVH2 triangles", (uint64_t)leaves * sizeof *triangles, triangles, &d->buffers[EC_ARG_BVH2_TRIS], err));
        if (boxes) EC_TRY(ec_buffer_create(&d->cl, "BVH2 boxes", (uint64_t)leaves * sizeof *boxes, boxes, &d->buffers[EC_ARG_BVH2_BOXES], err));
        free(binary);
        free(triangles);
        free(boxes);
    }
    ec_bvh_free(&bvh);
    return EC_OK;
}

ec_result bench_device_open(bench_device *d, const char *id, uint32_t lanes, const bench_mesh *mesh, float scene_max,
                            uint32_t most_rays, bool with_packet, ec_error *err)
{
    memset(d, 0, sizeof *d);
    ec_device_info *devices;
    uint32_t count, index;
    const char *why;
    EC_TRY(ec_devices_list(&devices, &count, err));
    ec_result result = ec_device_choose(devices, count, id, &index, &why, err);
    if (result == EC_OK) result = ec_cl_open(&devices[index], &d->cl, err);
    free(devices);
    EC_TRY(result);
    uint32_t width = lanes ? lanes : d->cl.info.native_float_width;
    d->lanes = width >= 16 ? 16 : (width >= 8 ? 8 : (width >= 4 ? 4 : 1));
    d->most_rays = most_rays;
    d->stride = (most_rays + 127) / 64 * 64;
    d->scene_max = scene_max;
    EC_TRY(upload_bvh(d, mesh, with_packet, err));
    const uint64_t field = (uint64_t)d->stride * 4;
    ec_params params = {.width = 8, .height = 8, .batch = 1, .wave = d->stride, .part = d->stride, .max_depth = 8, .scene_max = scene_max,
                        .scene_radius = 2.0f * scene_max};
    EC_TRY(ec_buffer_create(&d->cl, "parameters", sizeof params, &params, &d->buffers[EC_ARG_PARAMS], err));
    EC_TRY(ec_buffer_create(&d->cl, "counters", sizeof(ec_counters), NULL, &d->buffers[EC_ARG_COUNTERS], err));
    EC_TRY(ec_buffer_create(&d->cl, "invalid counts", 4 * EC_STAGE_COUNT, NULL, &d->buffers[EC_ARG_INVALID], err));
    EC_TRY(ec_buffer_create(&d->cl, "hits", field * EC_HIT_FIELDS, NULL, &d->buffers[EC_ARG_HITS], err));
    EC_TRY(ec_buffer_create(&d->cl, "radiance", field * 3, NULL, &d->buffers[EC_ARG_RADIANCE], err));
    return ec_buffer_zero(&d->cl, d->buffers[EC_ARG_RADIANCE], 0, field * 3, err);
}

void bench_device_close(bench_device *d)
{
    d->buffers[EC_ARG_PATHS] = d->buffers[EC_ARG_SHADOWS] = NULL;
    for (int i = 0; i < BENCH_KIND_COUNT; i++) ec_buffer_release(&d->cl, &d->queues[i]);
    for (int i = 0; i < EC_ARG_COUNT; i++) ec_buffer_release(&d->cl, &d->buffers[i]);
    ec_cl_close(&d->cl);
}

/* What tools/embed_kernels.py puts in front of every unit. */
static const char prelude[] = "#pragma OPENCL FP_CONTRACT OFF\n";

static char *read_source(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    size_t capacity = 1 << 20, length = sizeof prelude - 1, got;
    char *text = malloc(capacity + 1);
    if (text) memcpy(text, prelude, length);
    while (text && length < capacity && (got = fread(text + length, 1, capacity - length, file)) > 0) length += got;
    fclose(file);
    if (text) text[length] = 0;
    return text;
}

static ec_result build_stage(bench_device *d, bench_kernels *k, ec_stage_id id, ec_error *err)
{
    const ec_stage_entry *stage = &ec_stages[id];
    char options[4400], path[4200], name[64];
    uint32_t lanes = stage->lanes == EC_LANES_OF_PIPELINE ? d->lanes : stage->lanes;
    int used = snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x0u", lanes);
    const char *source = ec_kernel_source(stage->source);
    char *text = NULL;
    if (k->folder) {
        snprintf(path, sizeof path, "%s/stages/%s.cl", k->folder, stage->source);
        source = text = read_source(path);
        snprintf(options + used, sizeof options - (size_t)used, " -I %s/stages", k->folder);
    }
    if (!source) return ec_fail(err, "no kernel source %s", k->folder ? path : stage->source);
    snprintf(name, sizeof name, "ec_%s", stage->source);
    ec_result result = ec_program_build(&d->cl, stage->source, source, options, &k->programs[id], err);
    if (result == EC_OK) result = ec_kernel_create(k->programs[id], name, &k->kernels[id], err);
    free(text);
    return result;
}

ec_result bench_device_kernels(bench_device *d, bench_kernels *k, bool with_packet, ec_error *err)
{
    for (int trace = 0; trace < (with_packet ? BENCH_TRACE_COUNT : 1); trace++)
        for (int connect = 0; connect < 2; connect++) EC_TRY(build_stage(d, k, stages[trace][connect], err));
    return EC_OK;
}

void bench_device_release(bench_kernels *k)
{
    for (int i = 0; i < EC_STAGE_ID_COUNT; i++) {
        if (k->kernels[i]) clReleaseKernel(k->kernels[i]);
        if (k->programs[i]) clReleaseProgram(k->programs[i]);
    }
}

ec_result bench_device_rays(bench_device *d, bench_kind kind, const bench_rays *rays, ec_error *err)
{
    bool is_shadow = kind == BENCH_SHADOW;
    const size_t stride = d->stride, fields = is_shadow ? EC_SHADOW_FIELDS : EC_PATH_FIELDS;
    uint32_t *queue = calloc(fields * stride, 4);
    if (!queue) return ec_fail(err, "out of memory for %u rays", rays->count);
    float *f = (float *)queue;
    d->counts[kind] = rays->count;
    for (uint32_t i = 0; i < rays->count; i++) {
        const bench_ray *r = &rays->rays[i];
        for (size_t c = 0; c < 3; c++) {
            f[((is_shadow ? EC_SHADOW_OX : EC_PATH_OX) + c) * stride + i] = r->o[c];
            f[((is_shadow ? EC_SHADOW_DX : EC_PATH_DX) + c) * stride + i] = r->d[c];
            f[((is_shadow ? EC_SHADOW_LR : EC_PATH_BR) + c) * stride + i] = 1.0f;
        }
        queue[(is_shadow ? EC_SHADOW_SLOT : EC_PATH_SLOT) * stride + i] = i;
        queue[(is_shadow ? EC_SHADOW_PRIM : EC_PATH_PRIM) * stride + i] = EC_NO_ID;
        if (is_shadow) queue[EC_SHADOW_TARGET * stride + i] = EC_NO_ID;
    }
    ec_result result = ec_buffer_create(&d->cl, "rays", fields * stride * 4, queue, &d->queues[kind], err);
    free(queue);
    return result;
}

static ec_result prepare(bench_device *d, bench_kind kind, ec_error *err)
{
    d->buffers[kind == BENCH_SHADOW ? EC_ARG_SHADOWS : EC_ARG_PATHS] = d->queues[kind];
    ec_counters counters = {.rays = {{d->counts[kind]}}, .shadows = {{d->counts[kind]}}};
    EC_TRY(ec_buffer_write(&d->cl, d->buffers[EC_ARG_COUNTERS], 0, sizeof counters, &counters, err));
    if (kind == BENCH_SHADOW) EC_TRY(ec_buffer_zero(&d->cl, d->buffers[EC_ARG_RADIANCE], 0, (uint64_t)d->stride * 12, err));
    return ec_cl_finish(&d->cl, err);
}

static ec_result launch(bench_device *d, const bench_kernels *k, bench_trace trace, bench_kind kind, ec_error *err)
{
    ec_stage_id id = stage_of(trace, kind);
    const ec_stage_entry *stage = &ec_stages[id];
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    scalars[EC_ARG_BOUNCE] = kind == BENCH_CAMERA ? 0 : 1;
    scalars[EC_ARG_PATH_COUNT] = d->counts[kind];
    for (uint32_t i = 0; i < stage->argument_count; i++) {
        ec_arg arg = stage->arguments[i];
        cl_int code = arg < EC_ARG_SCALAR_COUNT
                          ? clSetKernelArg(k->kernels[id], i, sizeof(cl_uint), &scalars[arg])
                          : clSetKernelArg(k->kernels[id], i, sizeof(cl_mem), d->buffers[arg] ? &d->buffers[arg] : NULL);
        EC_TRY(ec_cl_check(code, "clSetKernelArg", stage->label, err));
    }
    uint64_t items = trace == BENCH_BVH8 ? d->counts[kind] : (d->counts[kind] + d->lanes - 1) / d->lanes;
    return ec_kernel_run(&d->cl, stage->label, k->kernels[id], items, EC_LOCAL_SIZE, err);
}

ec_result bench_device_trace(bench_device *d, const bench_kernels *k, bench_trace trace, bench_kind kind, double *seconds,
                             ec_error *err)
{
    EC_TRY(prepare(d, kind, err));
    double start = bench_clock();
    EC_TRY(launch(d, k, trace, kind, err));
    EC_TRY(ec_cl_finish(&d->cl, err));
    *seconds = bench_clock() - start;
    return EC_OK;
}

ec_result bench_device_found(bench_device *d, const bench_kernels *k, bench_trace trace, bench_kind kind,
                             bench_found *found, ec_error *err)
{
    EC_TRY(prepare(d, kind, err));
    EC_TRY(launch(d, k, trace, kind, err));
    const size_t stride = d->stride;
    bool is_shadow = kind == BENCH_SHADOW;
    float *words = malloc(3 * stride * 4);
    if (!words) return ec_fail(err, "out of memory");
    ec_result result = ec_buffer_read(&d->cl, d->buffers[is_shadow ? EC_ARG_RADIANCE : EC_ARG_HITS], 0, 3 * stride * 4, words, err);
    for (uint32_t i = 0; result == EC_OK && i < d->counts[kind]; i++) {
        if (is_shadow) { /* light arrived where nothing was in the way */
            found[i] = (bench_found){words[i] == 0.0f ? 0 : UINT32_MAX, words[i], words[i + stride]};
            continue;
        }
        memcpy(&found[i].prim, &words[EC_HIT_PRIM * stride + i], 4);
        found[i].b1 = words[EC_HIT_B1 * stride + i];
        found[i].b2 = words[EC_HIT_B2 * stride + i];
    }
    free(words);
    return result;
}
