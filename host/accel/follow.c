#include "accel/follow.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "accel/refit.h"
#include "base/clock.h"

const char *const ec_follow_names[] = {"built", "kept", "refitted", "rebuilt"};

/* A copy of an input, as far as structures depend on it. */
struct ec_followed_input {
    float *positions, *swept;
    uint32_t *indices;
    ec_shape *shapes;
    ec_placed *placed;
    uint32_t vertex_count, triangle_count, all_triangles, swept_count, shape_count, placed_count;
    bool whole;
    float grid_density;
};

static void free_input(struct ec_followed_input *i)
{
    if (!i) return;
    free(i->positions);
    free(i->swept);
    free(i->indices);
    free(i->shapes);
    free(i->placed);
    free(i);
}

/* Returns the number of all triangles: flat ones, and those of the shapes behind them. */
static uint32_t all_triangles(const ec_accel_input *in)
{
    const ec_shape *last = in->shape_count ? &in->shapes[in->shape_count - 1] : NULL;
    return last ? last->first + last->count : in->triangle_count;
}

static bool copy(void *to, const void *from, size_t count, size_t size)
{
    void *bytes = malloc(count * size + 1);
    if (bytes && count) memcpy(bytes, from, count * size);
    memcpy(to, &bytes, sizeof bytes); /* `to` is the address of a pointer of some type */
    return bytes != NULL;
}

static bool same(const void *a, const void *b, size_t count, size_t size) { return count == 0 || !memcmp(a, b, count * size); }

static ec_result remember(ec_followed *f, const ec_accel_input *in, ec_error *err)
{
    struct ec_followed_input *i = calloc(1, sizeof *i);
    free_input(f->input);
    f->input = i;
    if (i) *i = (struct ec_followed_input){.vertex_count = in->vertex_count, .triangle_count = in->triangle_count, .all_triangles = all_triangles(in),
                                           .swept_count = in->swept_count, .shape_count = in->shape_count, .placed_count = in->placed_count,
                                           .whole = in->whole, .grid_density = in->grid_density};
    bool copied = i && copy(&i->positions, in->positions, in->vertex_count, 3 * sizeof(float)) &&
                  copy(&i->swept, in->swept, in->swept_count, 6 * sizeof(float)) &&
                  copy(&i->indices, in->indices, i->all_triangles, 3 * sizeof(uint32_t)) &&
                  copy(&i->shapes, in->shapes, in->shape_count, sizeof *in->shapes) &&
                  copy(&i->placed, in->placed, in->placed_count, sizeof *in->placed);
    return copied ? EC_OK : ec_fail(err, "out of memory for the former places of %u triangles", in->triangle_count);
}

/* Returns whether the triangles are made of the same vertices as before, wherever these are now. */
static bool same_triangles(const struct ec_followed_input *i, const ec_accel_input *in)
{
    return i && i->vertex_count == in->vertex_count && i->triangle_count == in->triangle_count &&
           i->all_triangles == all_triangles(in) && i->swept_count == in->swept_count &&
           i->shape_count == in->shape_count && i->placed_count == in->placed_count && i->whole == in->whole &&
           i->grid_density == in->grid_density &&
           same(i->indices, in->indices, i->all_triangles, 3 * sizeof(uint32_t)) &&
           same(i->shapes, in->shapes, in->shape_count, sizeof *in->shapes);
}

/* Compares places without the padding behind them. */
static bool same_placed(const ec_placed *a, const ec_placed *b, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (memcmp(&a[i], &b[i], offsetof(ec_placed, mirrored)) || a[i].mirrored != b[i].mirrored) return false;
    return true;
}

static bool same_places(const struct ec_followed_input *i, const ec_accel_input *in)
{
    return same(i->positions, in->positions, in->vertex_count, 3 * sizeof(float)) &&
           same(i->swept, in->swept, in->swept_count, 6 * sizeof(float)) &&
           same_placed(i->placed, in->placed, in->placed_count);
}

static void drop(ec_followed *f)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) ec_accel_free(&f->accels[a]);
    f->present = 0;
}

static ec_result build(ec_followed *f, ec_accel_input *in, uint32_t wanted, ec_error *err)
{
    double start = ec_now();
    ec_result result = EC_OK;
    f->report.what = f->present ? EC_FOLLOW_REBUILT : EC_FOLLOW_BUILT;
    f->report.expense = 1;
    drop(f);
    ec_shape_trees_begin(&f->trees);
    in->trees = &f->trees;
    for (uint32_t a = 0; result == EC_OK && a < EC_ACCEL_COUNT; a++) {
        if (!(wanted >> a & 1)) continue;
        result = ec_accel_build(a, in, &f->accels[a], err);
        if (result == EC_OK) f->built_expense[a] = ec_accel_expense(a, &f->accels[a]);
    }
    ec_shape_trees_end(&f->trees);
    f->report.build_seconds = ec_now() - start;
    if (result != EC_OK) drop(f);
    else f->present = wanted;
    return result;
}

static bool can_refit(uint32_t wanted, const ec_accel_input *in)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (wanted >> a & 1 && !ec_accel_can_refit(a)) return false;
    return in->whole || in->swept_count; /* parts of cut triangles would have to be cut again */
}

/* Refits the structures in place; the report has the worst of them. */
static void refit(ec_followed *f, const ec_accel_input *in)
{
    double start = ec_now(), expense = 0;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!(f->present >> a & 1)) continue;
        ec_accel_refit(a, in, &f->accels[a]);
        if (f->built_expense[a] > 0) expense = fmax(expense, ec_accel_expense(a, &f->accels[a]) / f->built_expense[a]);
    }
    f->report.expense = f->report.refit_expense = expense > 0 ? expense : 1;
    f->report.refit_seconds = f->refit_seconds = ec_now() - start;
}

/* Returns whether a new build pays. trace_seconds is that of the moment before, whose trees cost `before` times what they cost when they were built. */
static bool is_worth_building(const ec_followed *f, double before)
{
    double fresh = f->trace_seconds / before;
    return fresh * (f->report.expense - 1) > f->report.build_seconds;
}

static ec_result follow_moved(ec_followed *f, ec_accel_input *in, uint32_t wanted, ec_error *err)
{
    double before = f->report.expense;
    if (f->refit_seconds > f->report.build_seconds) return build(f, in, wanted, err); /* this may happen on many cores */
    refit(f, in);
    f->report.what = EC_FOLLOW_REFITTED;
    return is_worth_building(f, before) ? build(f, in, wanted, err) : EC_OK;
}

ec_result ec_accels_follow(ec_followed *f, ec_accel_input *in, uint32_t wanted, ec_error *err)
{
    double start = ec_now();
    ec_result result = EC_OK;
    bool same_ones = f->present == wanted && same_triangles(f->input, in), stands = same_ones && same_places(f->input, in);
    f->report.refit_seconds = f->report.refit_expense = 0;
    if (stands) f->report.what = EC_FOLLOW_KEPT;
    else if (same_ones && can_refit(wanted, in)) result = follow_moved(f, in, wanted, err);
    else result = build(f, in, wanted, err);
    f->report.meshes_kept = stands ? f->trees.count : f->trees.found;
    f->report.meshes_built = stands ? 0 : f->trees.built;
    if (result == EC_OK && !stands) result = remember(f, in, err);
    if (result != EC_OK) drop(f);
    f->report.seconds = ec_now() - start;
    return result;
}

void ec_followed_tell(ec_followed *f, double trace_seconds) { f->trace_seconds = trace_seconds; }

void ec_followed_free(ec_followed *f)
{
    drop(f);
    free_input(f->input);
    ec_shape_trees_free(&f->trees);
    *f = (ec_followed){0};
}
