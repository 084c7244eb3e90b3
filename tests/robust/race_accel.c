/* Builds every acceleration structure with several threads under ThreadSanitizer (test_races.py). With an argument it makes a race of its
 * own, which must be found. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/refit.h"

enum { SIDE = 200, THREADS = 4, TRIANGLES = 2 * SIDE * SIDE };

/* A rough field of quads, every tenth one a long sliver: enough that builders split ranges into tasks and cut triangles into references. */
static void make_field(float *positions, uint32_t *indices)
{
    uint32_t noise = 1;
    for (uint32_t q = 0; q < SIDE * SIDE; q++) {
        float x = (float)(q % SIDE), y = (float)(q / SIDE), reach = q % 10 ? 1.0f : 30.0f;
        for (uint32_t k = 0; k < 4; k++) {
            noise = noise * 1664525u + 1013904223u;
            float *p = positions + 3 * (4 * q + k);
            p[0] = x + (float)(k % 2) * reach;
            p[1] = y + (float)(k / 2) * reach;
            p[2] = (float)(noise >> 16) / 65536.0f * 3.0f;
        }
        const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
        for (uint32_t k = 0; k < 6; k++) indices[6 * q + k] = 4 * q + corners[k];
    }
}

static int build_all(const float *positions, const uint32_t *indices)
{
    ec_accel_input input = {.positions = positions, .indices = indices, .triangle_count = TRIANGLES, .threads = THREADS};
    ec_error err = {0};
    int built = 0;
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        if (which == ec_accel_find("none")) continue; /* nothing to build: no threads */
        ec_accel accel;
        if (ec_accel_build(which, &input, &accel, &err) == EC_OK) built++;
        else fprintf(stderr, "%s: %s\n", ec_accels[which].name, err.text);
        ec_accel_free(&accel);
    }
    ec_accel_input_free(&input);
    return built;
}

/* Builds with whole triangles, for trees that are refitted. */
static int refit_all(float *positions, const uint32_t *indices)
{
    ec_error err = {0};
    int refitted = 0;
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        ec_accel_input input = {.positions = positions, .indices = indices, .triangle_count = TRIANGLES, .threads = THREADS, .whole = true};
        ec_accel accel;
        if (!ec_accel_can_refit(which) || ec_accel_build(which, &input, &accel, &err) != EC_OK) continue;
        for (uint32_t v = 0; v < 4 * SIDE * SIDE; v++) positions[3 * v + 2] += positions[3 * v] * 0.01f;
        ec_accel_refit(which, &input, &accel);
        refitted += ec_accel_expense(which, &accel) > 0;
        ec_accel_free(&accel);
        ec_accel_input_free(&input);
    }
    return refitted;
}

static int commit_race(void)
{
    int count = 0;
#pragma omp parallel for num_threads(THREADS)
    for (int i = 0; i < 100000; i++) count++;
    return count;
}

int main(int argc, char **argv)
{
    float *positions = malloc(sizeof(float) * 12 * SIDE * SIDE);
    uint32_t *indices = malloc(sizeof(uint32_t) * 3 * TRIANGLES);
    if (!positions || !indices) return 1;
    make_field(positions, indices);
    bool races = argc > 1 && !strcmp(argv[1], "race");
    int built = races ? commit_race() : build_all(positions, indices), refitted = races ? 0 : refit_all(positions, indices);
    printf("%d structures of %d triangles by %d threads, %d refitted\n", built, TRIANGLES, THREADS, refitted);
    free(positions);
    free(indices);
    return built >= EC_ACCEL_COUNT - 1 ? 0 : 1;
}
