/* The table of acceleration structures, and what they share. */
#include "accel/accel_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

#define ROW(name, lanes, summary) {#name, summary, lanes, ec_##name##_accel},
const ec_accel_kind ec_accels[EC_ACCEL_COUNT] = {EC_ACCELS(ROW)};
#define NAME(name, lanes, summary) #name,
const char *const ec_accel_names[] = {"auto", EC_ACCELS(NAME) NULL};

uint32_t ec_accel_find(const char *name)
{
    uint32_t i = 0;
    while (i < EC_ACCEL_COUNT && strcmp(ec_accels[i].name, name)) i++;
    return i;
}

/* A GPU gets the scalar kernel of bvh2. On a CPU packets win for camera rays, but gain less than a hundredth of the time of a scene of 130 000
 * triangles (docs/internals.md): not worth a second tree and its kernels. */
ec_result ec_accels_choose(const char *name, uint32_t triangle_count, bool is_cpu, uint32_t *chosen, ec_error *err)
{
    if (!name || !strcmp(name, "auto")) {
        uint32_t bvh2 = !is_cpu || triangle_count <= (1u << 17), bvh8 = is_cpu && triangle_count > 64;
        *chosen = bvh2 << ec_accel_find("bvh2") | bvh8 << ec_accel_find("bvh8");
        return EC_OK;
    }
    uint32_t one = ec_accel_find(name);
    if (one == EC_ACCEL_COUNT) return ec_fail(err, "no acceleration structure is named %s", name);
    *chosen = 1u << one;
    return EC_OK;
}

uint32_t ec_accels_needed(uint32_t chosen)
{
    uint32_t needed = 0;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (ec_accels[a].lanes) needed |= chosen & 1u << a;
    return needed ? needed : chosen;
}

ec_result ec_accel_build(uint32_t which, ec_accel_input *input, ec_accel *accel, ec_error *err)
{
    double start = ec_now();
    memset(accel, 0, sizeof *accel);
    ec_result result = ec_accels[which].build(input, accel, err);
    if (result != EC_OK) ec_accel_free(accel);
    accel->stats.build_seconds = ec_now() - start;
    for (int k = 0; k < EC_ACCEL_BUFFERS; k++) accel->stats.bytes += accel->buffers[k].bytes;
    return result;
}

void ec_accel_free(ec_accel *accel)
{
    for (int k = 0; k < EC_ACCEL_BUFFERS; k++) free(accel->buffers[k].data);
    memset(accel, 0, sizeof *accel);
}

void ec_accel_input_free(ec_accel_input *input)
{
    ec_bvh_free(&input->bvh);
}
