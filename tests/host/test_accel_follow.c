/* tier: quick */
/* Structures of moving meshes: kept where nothing moves; refitted or rebuilt, depending on measured times; always correct. Trees of meshes
 * that only change their place are not rebuilt. kernel/test_refit checks that refitted trees find every hit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/follow.h"
#include "accel/refit.h"
#include "base/fingerprint.h"
#include "support/test.h"

enum { SIDE = 40, VERTICES = (SIDE + 1) * (SIDE + 1), TRIANGLES = 2 * SIDE * SIDE };

typedef struct sheet {
    float positions[3 * VERTICES];
    uint32_t indices[3 * TRIANGLES];
} sheet;

/* A sheet with waves of this height. */
static void raise(sheet *s, float height)
{
    for (uint32_t v = 0; v < VERTICES; v++) {
        float x = (float)(v % (SIDE + 1)) / SIDE, y = (float)(v / (SIDE + 1)) / SIDE;
        s->positions[3 * v] = x;
        s->positions[3 * v + 1] = y;
        s->positions[3 * v + 2] = height * sinf(20 * x) * sinf(17 * y);
    }
}

static sheet *make_sheet(void)
{
    sheet *s = malloc(sizeof *s);
    raise(s, 0.1f);
    for (uint32_t q = 0; q < SIDE * SIDE; q++) {
        uint32_t at = q % SIDE + (SIDE + 1) * (q / SIDE), corner[6] = {at, at + 1, at + SIDE + 2, at, at + SIDE + 2, at + SIDE + 1};
        memcpy(s->indices + 6 * q, corner, sizeof corner);
    }
    return s;
}

static ec_accel_input input_of(const sheet *s)
{
    return (ec_accel_input){.positions = s->positions, .indices = s->indices, .triangle_count = TRIANGLES, .vertex_count = VERTICES, .whole = true};
}

static ec_follow follow(ec_followed *f, ec_accel_input input, uint32_t wanted)
{
    ec_error err = {0};
    CHECK_OK(ec_accels_follow(f, &input, wanted, &err), err);
    ec_accel_input_free(&input);
    CHECK(f->present == wanted);
    return f->report.what;
}

static uint32_t both(void) { return 1u << ec_accel_find("bvh2") | 1u << ec_accel_find("bvh8"); }

/* Checks that the root's box contains the sheet and is no larger. */
static void check_root(const ec_followed *f, const sheet *s)
{
    const ec_bvh8_node *root = f->accels[ec_accel_find("bvh8")].buffers[0].data;
    float lo = INFINITY, hi = -INFINITY, low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 8; k++) {
        if (root->child[k] == EC_NO_CHILD) continue;
        lo = fminf(lo, root->bound[4][k]);
        hi = fmaxf(hi, root->bound[5][k]);
    }
    for (uint32_t v = 0; v < VERTICES; v++) low = fminf(low, s->positions[3 * v + 2]), high = fmaxf(high, s->positions[3 * v + 2]);
    CHECK(lo == low && hi == high);
}

static void test_what_is_measured_decides(void)
{
    sheet *s = make_sheet();
    ec_followed f = {0};
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_BUILT);
    CHECK(f.report.build_seconds > 0 && f.report.refit_seconds == 0);
    const void *nodes = f.accels[ec_accel_find("bvh8")].buffers[0].data;
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_KEPT);
    CHECK(f.accels[ec_accel_find("bvh8")].buffers[0].data == nodes);
    raise(s, 0.2f);
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REFITTED); /* nothing is known about the rays: the cheapest correct choice */
    CHECK(f.report.expense > 1 && f.report.refit_seconds > 0);
    check_root(&f, s);
    raise(s, 0.3f);
    ec_followed_tell(&f, 1e-9); /* hardly any rays: no tree is worth building */
    f.refit_seconds = 0;        /* on a busy machine, the measured time may exceed a build */
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REFITTED);
    double expense = f.report.expense;
    raise(s, 0.4f);
    ec_followed_tell(&f, 1e6); /* days of rays: any gain pays */
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REBUILT);
    CHECK(expense > 1 && f.report.expense == 1);
    CHECK(f.report.refit_expense > expense || f.report.refit_expense == 0); /* none is tried if the previous try took longer than a build */
    check_root(&f, s);
    ec_followed_tell(&f, 1e6);
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_KEPT);
    raise(s, 0.41f);
    ec_followed_tell(&f, 0);
    f.refit_seconds = 2 * f.report.build_seconds; /* its measured time is longer than a build */
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REBUILT && f.report.refit_seconds == 0);
    ec_followed_free(&f);
    free(s);
}

/* The forecast: rays through a tree of twice the cost take twice as long. */
static void test_the_threshold(void)
{
    sheet *s = make_sheet();
    for (int more = 0; more < 2; more++) {
        ec_followed f = {0};
        raise(s, 0.01f);
        follow(&f, input_of(s), both());
        raise(s, 1.0f);
        follow(&f, input_of(s), both());
        double loss = f.report.expense - 1;
        CHECK_MSG(loss > 0.2, "waves a hundred times as high cost %.3f times as much", 1 + loss);
        raise(s, 1.0001f);
        f.refit_seconds = 0; /* on a busy machine, the measured time may exceed a build */
        ec_followed_tell(&f, (more ? 1.5 : 0.5) * f.report.build_seconds / loss * (1 + loss)); /* measured with trees of that cost */
        CHECK((follow(&f, input_of(s), both()) == EC_FOLLOW_REBUILT) == (more == 1));
        ec_followed_free(&f);
    }
    free(s);
}

static void test_other_triangles_are_built(void)
{
    sheet *s = make_sheet();
    ec_followed f = {0};
    ec_accel_input fewer = input_of(s), cut = input_of(s);
    follow(&f, input_of(s), both());
    fewer.triangle_count -= 2;
    CHECK(follow(&f, fewer, both()) == EC_FOLLOW_REBUILT);
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REBUILT);
    uint32_t first = s->indices[0];
    s->indices[0] = 5;
    CHECK(follow(&f, input_of(s), both()) == EC_FOLLOW_REBUILT);
    s->indices[0] = first;
    follow(&f, input_of(s), both());
    CHECK(follow(&f, input_of(s), 1u << ec_accel_find("kdtree")) == EC_FOLLOW_REBUILT);
    CHECK(follow(&f, input_of(s), 1u << ec_accel_find("kdtree")) == EC_FOLLOW_KEPT);
    raise(s, 0.3f);
    CHECK(follow(&f, input_of(s), 1u << ec_accel_find("kdtree")) == EC_FOLLOW_REBUILT); /* cells cannot be refitted */
    cut.whole = false;
    CHECK(follow(&f, cut, both()) == EC_FOLLOW_REBUILT);
    raise(s, 0.4f);
    CHECK(follow(&f, cut, both()) == EC_FOLLOW_REBUILT); /* parts would have to be cut again */
    ec_followed_free(&f);
    free(s);
}

static void test_meshes_stay(void)
{
    sheet *s = make_sheet();
    uint32_t two = 1u << ec_accel_find("twolevel");
    ec_shape shapes[2] = {{.first = 2, .count = TRIANGLES / 2 - 2, .first_vertex = 0, .vertex_count = VERTICES},
                          {.first = TRIANGLES / 2, .count = TRIANGLES / 2, .first_vertex = 0, .vertex_count = VERTICES}};
    ec_placed placed[3] = {{.shape = 0, .id = 2, .place = {{1}, {0, 1}, {0, 0, 1}}},
                           {.shape = 0, .id = TRIANGLES, .place = {{1, 0, 0, 3}, {0, 1}, {0, 0, 1}}},
                           {.shape = 1, .id = 2 * TRIANGLES, .place = {{1, 0, 0, 6}, {0, 1}, {0, 0, 1}}}};
    ec_followed f = {0};
    ec_accel_input in = input_of(s);
    in.triangle_count = 2;
    in.shape_count = 2;
    in.shapes = shapes;
    in.placed_count = 3;
    in.placed = placed;
    CHECK(follow(&f, in, two) == EC_FOLLOW_BUILT && f.report.meshes_built == 2);
    ec_accel anew = {0};
    placed[1].place[0][3] = 4; /* an instance moves */
    CHECK(follow(&f, in, two) == EC_FOLLOW_REBUILT);
    CHECK_MSG(f.report.meshes_built == 0 && f.report.meshes_kept == 2, "%u meshes built, %u kept", f.report.meshes_built, f.report.meshes_kept);
    ec_error err = {0};
    ec_accel_input alone = in;
    CHECK_OK(ec_accel_build(ec_accel_find("twolevel"), &alone, &anew, &err), err);
    for (int k = 0; k < EC_ACCEL_BUFFERS; k++) {
        const ec_accel_buffer *a = &anew.buffers[k], *b = &f.accels[ec_accel_find("twolevel")].buffers[k];
        CHECK(a->bytes == b->bytes && (!a->bytes || !memcmp(a->data, b->data, a->bytes)));
    }
    ec_accel_input_free(&alone);
    ec_accel_free(&anew);
    raise(s, 0.5f); /* both meshes change */
    CHECK(follow(&f, in, two) == EC_FOLLOW_REBUILT && f.report.meshes_built == 2 && f.trees.count == 2);
    ec_followed_free(&f);
    free(s);
}

/* A changed bit anywhere, a byte more or less, or another order changes the fingerprint. */
static void test_fingerprints(void)
{
    uint8_t bytes[100];
    for (int i = 0; i < 100; i++) bytes[i] = (uint8_t)(7 * i);
    const ec_fingerprint none = {{0}}, all = ec_fingerprint_add(none, bytes, sizeof bytes);
    for (int bit = 0; bit < 800; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        CHECK(!ec_fingerprint_is(all, ec_fingerprint_add(none, bytes, sizeof bytes)));
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    CHECK(ec_fingerprint_is(all, ec_fingerprint_add(none, bytes, sizeof bytes)));
    for (uint64_t size = 0; size < 100; size++) CHECK(!ec_fingerprint_is(all, ec_fingerprint_add(none, bytes, size)));
    ec_fingerprint ab = ec_fingerprint_add(ec_fingerprint_add(none, bytes, 32), bytes + 32, 32);
    CHECK(!ec_fingerprint_is(ab, ec_fingerprint_add(ec_fingerprint_add(none, bytes + 32, 32), bytes, 32)));
}

int main(void)
{
    test_what_is_measured_decides();
    test_the_threshold();
    test_other_triangles_are_built();
    test_meshes_stay();
    test_fingerprints();
    TEST_END();
}
