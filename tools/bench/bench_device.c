#include "bench_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shared/params.h"
#include "shared/path_state.h"

static ec_stage_id stage_of(bench_kind kind) { return kind == BENCH_SHADOW ? EC_CONNECT : EC_INTERSECT; }

static void CL_CALLBACK free_memory(cl_mem buffer, void *memory)
{
    (void)buffer;
    free(memory);
}

/* Puts a buffer on the device as a render does: a processor works on the builder's own memory, which has large pages. */
static ec_result put(ec_cl *cl, ec_accel_buffer *from, cl_mem *buffer, ec_error *err)
{
    if (!ec_buffer_adopt(cl, from->label, from->bytes, from->data, free_memory, from->data, buffer))
        return ec_buffer_create(cl, from->label, from->bytes, from->data, buffer, err);
    from->data = NULL;
    return EC_OK;
}

static ec_result upload_accels(bench_device *d, const bench_mesh *mesh, uint32_t accels, float grid_density, ec_error *err)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!(accels >> a & 1)) continue;
        ec_accel_input input = {.positions = mesh->positions, .indices = mesh->indices, .triangle_count = mesh->triangle_count,
                                .grid_density = grid_density};
        ec_accel accel;
        ec_result result = ec_accel_build(a, &input, &accel, err);
        for (int k = 0; result == EC_OK && k < EC_ACCEL_BUFFERS; k++)
            if (accel.buffers[k].data) result = put(&d->cl, &accel.buffers[k], &d->accel_buffers[a][k], err);
        d->accel_stats[a] = accel.stats;
        ec_accel_free(&accel);
        ec_accel_input_free(&input);
        EC_TRY(result);
    }
    return EC_OK;
}

ec_result bench_device_open(bench_device *d, const char *id, uint32_t lanes, const bench_mesh *mesh, float scene_max,
                            uint32_t most_rays, uint32_t accels, float grid_density, ec_error *err)
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
    EC_TRY(upload_accels(d, mesh, accels, grid_density, err));
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
    for (int a = 0; a < EC_ACCEL_COUNT; a++)
        for (int k = 0; k < EC_ACCEL_BUFFERS; k++) ec_buffer_release(&d->cl, &d->accel_buffers[a][k]);
    memset(&d->buffers[EC_ARG_ACCEL], 0, sizeof d->accel_buffers[0]);
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

static ec_result build_accel(bench_device *d, bench_kernels *k, uint32_t accel, ec_error *err)
{
    char options[4400], path[4200], name[64], unit[64];
    const ec_traversal way = ec_traversal_of(&d->cl.info, accel, d->accel_stats[accel].bytes, 0, d->lanes);
    int used = snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x0u%s", way.lanes, way.options);
    snprintf(unit, sizeof unit, "traverse_%s", ec_accels[accel].name);
    const char *source = ec_kernel_source(unit);
    char *text = NULL;
    if (k->folder) {
        snprintf(path, sizeof path, "%s/lib/%s.h", k->folder, unit);
        source = text = read_source(path);
        snprintf(options + used, sizeof options - (size_t)used, " -I %s/lib", k->folder);
    }
    if (!source) return ec_fail(err, "no kernel source %s", k->folder ? path : unit);
    ec_result result = ec_program_build(&d->cl, unit, source, options, &k->programs[accel], err);
    for (int connect = 0; result == EC_OK && connect < 2; connect++) {
        snprintf(name, sizeof name, "ec_%s_%s", ec_stages[connect ? EC_CONNECT : EC_INTERSECT].source, ec_accels[accel].name);
        result = ec_kernel_create(k->programs[accel], name, &k->kernels[accel][connect], err);
    }
    free(text);
    return result;
}

ec_result bench_device_kernels(bench_device *d, bench_kernels *k, uint32_t accels, ec_error *err)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (accels >> a & 1) EC_TRY(build_accel(d, k, a, err));
    return EC_OK;
}

void bench_device_release(bench_kernels *k)
{
    for (int a = 0; a < EC_ACCEL_COUNT; a++) {
        for (int i = 0; i < 2; i++)
            if (k->kernels[a][i]) clReleaseKernel(k->kernels[a][i]);
        if (k->programs[a]) clReleaseProgram(k->programs[a]);
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
        queue[(is_shadow ? EC_SHADOW_PRIM : EC_PATH_PRIM) * stride + i] = r->leaves;
        if (is_shadow) queue[EC_SHADOW_TARGET * stride + i] = EC_NO_ID;
    }
    ec_result result = ec_buffer_create(&d->cl, "rays", fields * stride * 4, queue, &d->queues[kind], err);
    free(queue);
    return result;
}

static ec_result prepare(bench_device *d, bench_kind kind, ec_error *err)
{
    d->buffers[kind == BENCH_SHADOW ? EC_ARG_SHADOWS : EC_ARG_PATHS] = d->queues[kind];
    ec_counters counters = {.at = {{.rays = {d->counts[kind]}, .shadows = {d->counts[kind]}}}};
    EC_TRY(ec_buffer_write(&d->cl, d->buffers[EC_ARG_COUNTERS], 0, sizeof counters, &counters, err));
    if (kind == BENCH_SHADOW) EC_TRY(ec_buffer_zero(&d->cl, d->buffers[EC_ARG_RADIANCE], 0, (uint64_t)d->stride * 12, err));
    return ec_cl_finish(&d->cl, err);
}

static ec_result launch(bench_device *d, const bench_kernels *k, uint32_t accel, bench_kind kind, ec_error *err)
{
    const ec_stage_entry *stage = &ec_stages[stage_of(kind)];
    cl_kernel kernel = k->kernels[accel][kind == BENCH_SHADOW];
    memcpy(&d->buffers[EC_ARG_ACCEL], d->accel_buffers[accel], sizeof d->accel_buffers[accel]);
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    scalars[EC_ARG_BOUNCE] = scalars[EC_ARG_SORTS] = kind == BENCH_CAMERA ? 0 : 1;
    scalars[EC_ARG_PATH_COUNT] = d->counts[kind];
    for (uint32_t i = 0; i < stage->argument_count; i++) {
        ec_arg arg = stage->arguments[i];
        cl_int code = arg < EC_ARG_SCALAR_COUNT
                          ? clSetKernelArg(kernel, i, sizeof(cl_uint), &scalars[arg])
                          : clSetKernelArg(kernel, i, sizeof(cl_mem), d->buffers[arg] ? &d->buffers[arg] : NULL);
        EC_TRY(ec_cl_check(code, "clSetKernelArg", stage->label, err));
    }
    const uint32_t takes = ec_traversal_of(&d->cl.info, accel, d->accel_stats[accel].bytes, 0, d->lanes).takes;
    const uint64_t items = (d->counts[kind] + takes - 1) / takes;
    return ec_kernel_run(&d->cl, stage->label, kernel, items, EC_LOCAL_SIZE, err);
}

ec_result bench_device_trace(bench_device *d, const bench_kernels *k, uint32_t accel, bench_kind kind, double *seconds,
                             ec_error *err)
{
    EC_TRY(prepare(d, kind, err));
    double start = bench_clock();
    EC_TRY(launch(d, k, accel, kind, err));
    EC_TRY(ec_cl_finish(&d->cl, err));
    *seconds = bench_clock() - start;
    return EC_OK;
}

ec_result bench_device_found(bench_device *d, const bench_kernels *k, uint32_t accel, bench_kind kind,
                             bench_found *found, ec_error *err)
{
    EC_TRY(prepare(d, kind, err));
    EC_TRY(launch(d, k, accel, kind, err));
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
