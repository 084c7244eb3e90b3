/* tiers: quick, long */
/* Trees whose triangles have moved: refitted trees find every hit with every ray, bit by bit, however poor the boxes are; and where nothing
 * has moved, no byte changes. */
#include "accel/refit.h"
#include "kernel/traversal_run.h"

#define RAYS 4000u
#define COUNT (RAYS - 3u) /* not a multiple of the lanes */

static const tracer *tracer_of(const char *accel)
{
    const tracer *t = tracers;
    while (t->accel != ec_accel_find(accel)) t++;
    return t;
}

static bool build(const ec_accel_input *from, uint32_t which, ec_accel *accel)
{
    ec_accel_input input = *from;
    ec_error err = {0};
    input.whole = true;
    input.bvh = (ec_bvh){0};
    ec_result result = ec_accel_build(which, &input, accel, &err);
    CHECK_OK(result, err);
    ec_accel_input_free(&input);
    return result == EC_OK;
}

static void check_still(const ec_accel_input *input, uint32_t which, const char *name)
{
    ec_accel before, after;
    if (!build(input, which, &before) || !build(input, which, &after)) return;
    ec_accel_refit(which, input, &after);
    for (int k = 0; k < EC_ACCEL_BUFFERS; k++) {
        if (!before.buffers[k].data) continue;
        CHECK_MSG(!memcmp(before.buffers[k].data, after.buffers[k].data, before.buffers[k].bytes), "%s, %s: %s change without a move", name,
                  ec_accels[which].name, before.buffers[k].label);
    }
    CHECK(ec_accel_expense(which, &before) == ec_accel_expense(which, &after));
    ec_accel_free(&before);
    ec_accel_free(&after);
}

/* from: the triangles for which trees are built; to: the same triangles, moved. */
static void check_moved(set from, set to)
{
    uint32_t *indices, none = ec_accel_find("none");
    set_finish(&from);
    set_finish(&to);
    ec_accel_input before = set_input(&from, &indices), after = before;
    after.positions = to.vertices;
    ec_accel every;
    float *queue = calloc(EC_PATH_FIELDS * RAYS, sizeof *queue);
    float *expected = calloc(EC_HIT_PROBE_FIELDS * RAYS, sizeof *expected), *hits = calloc(EC_HIT_PROBE_FIELDS * RAYS, sizeof *hits);
    make_rays(&to, queue, RAYS, EC_PATH_FIELDS, EC_PATH_PRIM, true);
    if (build(&after, none, &every) && intersect(&to, tracer_of("none"), &every, RAYS, COUNT, queue, expected)) {
        for (uint32_t i = 0; i < tracer_count; i++) {
            uint32_t which = tracers[i].accel;
            ec_accel accel;
            if (!ec_accel_can_refit(which)) continue;
            check_still(&before, which, from.name);
            if (!build(&before, which, &accel)) continue;
            double built = ec_accel_expense(which, &accel);
            ec_accel_refit(which, &after, &accel);
            CHECK_MSG(built > 0 && ec_accel_expense(which, &accel) > 0, "%s: nothing is known of its cost", tracers[i].label);
            if (intersect(&to, &tracers[i], &accel, RAYS, COUNT, queue, hits)) {
                uint32_t hit = same_hits(&to, queue, RAYS, COUNT, hits, expected, tracers[i].label, "every triangle");
                CHECK_MSG(hit > COUNT / 20, "%s: only %u rays hit", to.name, hit);
            }
            ec_accel_free(&accel);
        }
        ec_accel_free(&every);
    }
    free(queue);
    free(expected);
    free(hits);
    free(indices);
    free(from.vertices);
    free(to.vertices);
}

static set copy_of(const set *s)
{
    set copy = set_make(s->name, s->triangles, s->size);
    memcpy(copy.vertices, s->vertices, 9 * (size_t)s->triangles * sizeof *copy.vertices);
    return copy;
}

/* Every corner moves by itself: quads separate, edges open. */
static void check_shaken(set s, float by)
{
    set to = copy_of(&s);
    for (size_t k = 0; k < 9 * (size_t)s.triangles; k++) to.vertices[k] += by * random_float(-1, 1);
    check_moved(s, to);
}

/* All corners move together: quads stay quads. */
static void check_turned(set s)
{
    set to = copy_of(&s);
    for (size_t v = 0; v < 3 * (size_t)s.triangles; v++) {
        const float *p = s.vertices + 3 * v;
        float *q = to.vertices + 3 * v;
        q[0] = 0.6f * p[0] - 0.8f * p[1];
        q[1] = 0.8f * p[0] + 0.6f * p[1];
    }
    check_moved(s, to);
}

/* The tree's measured cost rises when triangles that were together are apart. */
static void check_expense(void)
{
    set s = set_random("random", 1500, 1.0f, 0.02f), other = set_random("elsewhere", 1500, 1.0f, 0.02f);
    uint32_t *indices;
    ec_accel_input before = set_input(&s, &indices), after = before;
    after.positions = other.vertices;
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        ec_accel accel, anew;
        if (!ec_accel_can_refit(which) || !build(&before, which, &accel) || !build(&after, which, &anew)) continue;
        ec_accel_refit(which, &after, &accel);
        double ratio = ec_accel_expense(which, &accel) / ec_accel_expense(which, &anew);
        CHECK_MSG(ratio > 3, "%s: a tree of what lay elsewhere costs %.2f times one that is built anew", ec_accels[which].name, ratio);
        ec_accel_free(&accel);
        ec_accel_free(&anew);
    }
    free(indices);
    free(s.vertices);
    free(other.vertices);
}

int main(void)
{
    int open = open_tracers(true);
    if (open) return open;
    check_moved(set_random("one", 1, 1.0f, 1.0f), set_random("one elsewhere", 1, 1.0f, 1.0f));
    check_moved(set_random("random", 1500, 1.0f, 0.1f), set_random("elsewhere", 1500, 1.0f, 0.1f));
    check_shaken(set_blocks(1500), 0.05f);
    check_turned(set_blocks(1500));
    check_shaken(set_fan(720), 0.01f);
    check_shaken(set_slivers(1500), 0.1f);
    check_turned(set_duplicated(800));
    check_turned(set_building(6000));
    check_expense();
    close_tracers();
    TEST_END();
}
