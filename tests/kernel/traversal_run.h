/* Runs the kernels of the accelerators over queues of rays. */
#ifndef EC_TESTS_KERNEL_TRAVERSAL_RUN_H
#define EC_TESTS_KERNEL_TRAVERSAL_RUN_H

#include "accel/accel.h"
#include "cl/build_log.h"
#include "kernel/kernel_run.h"
#include "kernel/traversal_sets.h"
#include "shared/params.h"

static ec_cl cl;

/* An accelerator's kernels with one lane width. */
typedef struct tracer {
    uint32_t accel, lanes; /* lanes: rays a work-item */
    char label[48];
    cl_program program;
} tracer;
#define TRACERS_MOST (EC_ACCEL_COUNT + LANE_WIDTHS + 3)
static tracer tracers[TRACERS_MOST];
static uint32_t tracer_count;

/* more: compiler options, shown in the label. */
static inline void add_tracer(uint32_t accel, uint32_t lanes, const char *more)
{
    char name[64], options[96];
    ec_error err = {0};
    tracer *t = &tracers[tracer_count++];
    uint32_t width = ec_accels[accel].lanes ? ec_accels[accel].lanes : lanes;
    *t = (tracer){.accel = accel, .lanes = lanes};
    if (lanes > 1) snprintf(t->label, sizeof t->label, "%s of %u", ec_accels[accel].name, lanes);
    else snprintf(t->label, sizeof t->label, "%s%s", ec_accels[accel].name, more);
    snprintf(name, sizeof name, "traverse_%s", ec_accels[accel].name);
    snprintf(options, sizeof options, "-DFEATURES=0 -DPROBE -DLANES=%u%s", width, more);
    CHECK_OK(ec_program_build(&cl, name, ec_kernel_source(name), options, &t->program, &err), err);
    char *log = ec_build_log(&cl, t->program); /* PoCL prints a count of warnings to the user */
    CHECK_MSG(!log || !strstr(log, "warning:"), "%s: %s", t->label, log);
    free(log);
}

/* Opens the device and builds every accelerator: packets of each width or only of 8; bvh8 also with interleaved rays, with and without
 * AVX2; bvh2 also without a stack. Returns main's exit code, or 0. */
static inline int open_tracers(bool all_widths)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (ec_accels[a].lanes) add_tracer(a, 1, "");
        for (int i = 0; !ec_accels[a].lanes && i < kernel_widths(&cl); i++)
            if (all_widths || lane_widths[i] == 8) add_tracer(a, (uint32_t)lane_widths[i], "");
    }
    add_tracer(ec_accel_find("bvh8"), 1, " -DINTERLEAVE=8"); /* as in large scenes */
    add_tracer(ec_accel_find("bvh8"), 1, " -DINTERLEAVE=8 -DPERMUTES_LANES=0"); /* on CPUs without AVX2 */
    add_tracer(ec_accel_find("bvh2"), 1, " -DSTACK_ENTRIES=1"); /* as in trees deeper than the stack */
    return test_failures != 0;
}

static inline void close_tracers(void)
{
    for (uint32_t i = 0; i < tracer_count; i++)
        if (tracers[i].program) clReleaseProgram(tracers[i].program);
    ec_cl_close(&cl);
}

static inline ec_accel_input set_input(const set *s, uint32_t **indices)
{
    *indices = malloc((3 * (size_t)s->triangles + 1) * sizeof **indices);
    for (uint32_t i = 0; i < 3 * s->triangles; i++) (*indices)[i] = i;
    return (ec_accel_input){.positions = s->vertices, .indices = *indices, .triangle_count = s->triangles};
}

/* One structure of each kind that accepts so many triangles; the others stay empty. */
static inline bool build_accels(const set *s, ec_accel accels[EC_ACCEL_COUNT])
{
    ec_error err = {0};
    int before = test_failures;
    uint32_t *indices;
    ec_accel_input input = set_input(s, &indices);
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        accels[a] = (ec_accel){0};
        if (a != ec_accel_find("none") || s->triangles < 2000) CHECK_OK(ec_accel_build(a, &input, &accels[a], &err), err);
    }
    ec_accel_input_free(&input);
    free(indices);
    return test_failures == before;
}

static inline void free_accels(ec_accel accels[EC_ACCEL_COUNT])
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) ec_accel_free(&accels[a]);
}

static uint32_t zero = 0, bounce = 1;
static float nothing[256];

#define NO_ATTRIBUTES IN(nothing, 16), IN(nothing, 16), IN(nothing, 16), IN(nothing, 16), IN(nothing, 64), IN(nothing, 16), \
    IN(nothing, 16), IN(nothing, 256), {NULL, 0, KERNEL_IN}, {NULL, 0, KERNEL_IN}, {NULL, 0, KERNEL_IN}, {NULL, 0, KERNEL_IN}
#define ALL_PIXELS {NULL, 0, KERNEL_IN}
#define WAVE IN(&params, 1), SCALAR(zero), SCALAR(zero), ALL_PIXELS, SCALAR(bounce), SCALAR(zero), IN(&counters, 1), SCALAR(sorts)
#define BUFFER(k) {a->buffers[k].data, a->buffers[k].data ? a->buffers[k].bytes : 0, KERNEL_IN}
#define BUFFERS BUFFER(0), BUFFER(1), BUFFER(2), BUFFER(3), BUFFER(4)

static inline bool intersect_in_order(const set *s, const tracer *t, const ec_accel *a, uint32_t wave, uint32_t count, const float *paths,
                                      uint32_t sorts, float *hits)
{
    char name[64];
    ec_params params = {.wave = wave, .part = wave, .batch = 1, .width = 1, .height = 1, .scene_max = s->scene_max};
    ec_counters counters = {.at = {{.rays = {count}}}};
    snprintf(name, sizeof name, "ec_intersect_%s", ec_accels[t->accel].name);
    for (size_t f = 0; f < EC_HIT_PROBE_FIELDS; f++) memset(hits + f * wave, 0xa5, count * sizeof *hits); /* none is left from an earlier call */
    return KERNEL_CALL(&cl, t->program, name, (count + t->lanes - 1) / t->lanes, WAVE, IN(paths, EC_PATH_FIELDS * (size_t)wave),
                       OUT(hits, EC_HIT_PROBE_FIELDS * (size_t)wave), BUFFERS, NO_ATTRIBUTES);
}

static inline bool connect_in_order(const set *s, const tracer *t, const ec_accel *a, uint32_t wave, uint32_t count, const float *shadows,
                                    uint32_t sorts, float *radiance)
{
    char name[64];
    ec_params params = {.wave = wave, .part = wave, .batch = 1, .width = 1, .height = 1, .scene_max = s->scene_max};
    ec_counters counters = {.at = {{.shadows = {count}}}};
    uint32_t invalid[EC_STAGE_COUNT] = {0};
    memset(radiance, 0, 3 * (size_t)wave * sizeof *radiance);
    snprintf(name, sizeof name, "ec_connect_%s", ec_accels[t->accel].name);
    bool good = KERNEL_CALL(&cl, t->program, name, (count + t->lanes - 1) / t->lanes, WAVE, OUT(invalid, EC_STAGE_COUNT),
                            IN(shadows, EC_SHADOW_FIELDS * (size_t)wave), OUT(radiance, 3 * (size_t)wave), BUFFERS, NO_ATTRIBUTES,
                            IN(nothing, 16), IN(nothing, 16));
    for (int i = 0; i < EC_STAGE_COUNT; i++) CHECK(invalid[i] == 0);
    return good;
}

/* Packets give the same bits whether or not they sort their rays: compares the first `count` values of each field. */
static inline void same_sorted(const tracer *t, const float *plain, const float *sorted, size_t fields, uint32_t wave, uint32_t count)
{
    for (size_t f = 0; f < fields; f++)
        CHECK_MSG(!memcmp(plain + f * wave, sorted + f * wave, count * sizeof *plain), "%s: field %zu is another where rays are sorted", t->label, f);
}

/* Closest hits of the first `count` of `wave` paths, EC_HIT_PROBE_FIELDS each. */
static inline bool intersect(const set *s, const tracer *t, const ec_accel *a, uint32_t wave, uint32_t count, const float *paths, float *hits)
{
    if (t->lanes > 1) {
        float *sorted = malloc(EC_HIT_PROBE_FIELDS * (size_t)wave * sizeof *sorted);
        memcpy(sorted, hits, EC_HIT_PROBE_FIELDS * (size_t)wave * sizeof *sorted);
        bool good = intersect_in_order(s, t, a, wave, count, paths, 1, sorted) && intersect_in_order(s, t, a, wave, count, paths, 0, hits);
        if (good) same_sorted(t, hits, sorted, EC_HIT_T + 1, wave, count);
        free(sorted);
        return good;
    }
    if (strstr(t->label, "INTERLEAVE")) { /* camera rays in packets give the same bits */
        float *together = malloc(EC_HIT_PROBE_FIELDS * (size_t)wave * sizeof *together);
        bounce = 0;
        bool good = intersect_in_order(s, t, a, wave, count, paths, 0, together);
        bounce = 1;
        good = good && intersect_in_order(s, t, a, wave, count, paths, 0, hits);
        for (size_t f = 0; good && f <= EC_HIT_T; f++)
            CHECK_MSG(!memcmp(together + f * wave, hits + f * wave, count * sizeof *hits), "%s: field %zu is another where they are camera rays", t->label, f);
        free(together);
        return good;
    }
    return intersect_in_order(s, t, a, wave, count, paths, 0, hits);
}

/* Light that shadow rays carry and that arrives, in three colours. */
static inline bool connect(const set *s, const tracer *t, const ec_accel *a, uint32_t wave, uint32_t count, const float *shadows, float *radiance)
{
    if (t->lanes > 1) {
        float *sorted = malloc(3 * (size_t)wave * sizeof *sorted);
        bool good = connect_in_order(s, t, a, wave, count, shadows, 1, sorted) && connect_in_order(s, t, a, wave, count, shadows, 0, radiance);
        if (good) same_sorted(t, radiance, sorted, 3, wave, wave);
        free(sorted);
        return good;
    }
    return connect_in_order(s, t, a, wave, count, shadows, 0, radiance);
}

static inline void print_ray(const set *s, const float *queue, uint32_t rays, uint32_t i, uint32_t prim)
{
    fprintf(stderr, "  o");
    for (uint32_t k = 0; k < 6; k++) fprintf(stderr, "%s%a", k == 3 ? " d " : " ", (double)queue[k * (size_t)rays + i]);
    fprintf(stderr, " scene_max %a", (double)s->scene_max);
    for (uint32_t k = 0; prim != EC_NO_ID && k < 9; k++) fprintf(stderr, "%s%a", k % 3 ? " " : " v ", (double)s->vertices[9 * (size_t)prim + k]);
    fputc('\n', stderr);
}

/* Compares triangle, barycentrics and t bit by bit, and prints the first difference. Returns the number of hits. */
static inline uint32_t same_hits(const set *s, const float *paths, uint32_t rays, uint32_t count, const float *hits,
                                 const float *expected, const char *label, const char *reference)
{
    const uint32_t *got = (const uint32_t *)hits, *want = (const uint32_t *)expected;
    uint32_t wrong = 0, hit = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool same = true;
        for (size_t f = 0; f <= EC_HIT_T; f++) same &= got[f * rays + i] == want[f * rays + i];
        hit += want[i] != EC_NO_ID;
        if (same || wrong++) continue;
        fprintf(stderr, "%s, %s: ray %u hits %d (b %.9g %.9g t %.9g), %s %d (b %.9g %.9g t %.9g)\n", s->name, label, i, (int)got[i],
                (double)hits[rays + i], (double)hits[2 * (size_t)rays + i], (double)hits[3 * (size_t)rays + i], reference, (int)want[i],
                (double)expected[rays + i], (double)expected[2 * (size_t)rays + i], (double)expected[3 * (size_t)rays + i]);
        print_ray(s, paths, rays, i, want[i]);
    }
    CHECK_MSG(wrong == 0, "%s, %s: %u of %u rays differ from %s", s->name, label, wrong, count, reference);
    return hit;
}

#endif
