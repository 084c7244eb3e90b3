/* Traces one ray through a uniform grid: the 3D-DDA of Amanatides and Woo 1987 for a ray as wide as its rounding, over blocks of 4 x 4 x 4
 * cells; within a block all 64 cells are compared at once, in the lanes of vectors, and most are empty.
 *
 * Along each axis the ray is in one block or, near a plane, in two: a block begins for it at its near plane with the widened offset
 * and ends at its far one, by the arithmetic of slab_near. The next block to begin along any axis is the next step, and the blocks
 * visited are the new one with those along the other axes that have not ended. So every block is visited whose widened slab
 * the ray meets, once, in the order of entry; and within it every cell of which the same is true.
 *
 * Why no hit is lost: let t be a hit's distance, clamped to the near side of the triangle's box, and s <= t that near side. Along
 * each axis the box is covered by cells that hold the triangle, and one of them has begun and not ended at s, because planes
 * and box go through the same monotone arithmetic. These three make a cell that is entered no later than t. */
#ifndef EC_LIB_TRAVERSE_GRID_H
#define EC_LIB_TRAVERSE_GRID_H

#include "block8.h"

#define GRID_MAIL 32u  /* triangles tested last, by the low bits of their index: a triangle in many cells is tested about once */

typedef struct grid_axis {
    global const float *plane;   /* plane[4 i]: the far plane of block i, seen along the ray */
    float inverse, near_offset, far_offset;
    int step, stride;            /* to the next block, in blocks along the axis and in blocks of the grid */
    int oldest, newest, end;     /* blocks that the ray is in; the last one of the grid */
    float begins, ends;          /* when the block after `newest` begins, when `oldest` ends */
} grid_axis;

/* Triangles that wait to be tested. */
typedef struct grid_mail {
    uint seen[GRID_MAIL];
    uint pending[8], count;
} grid_mail;

EC_FN float grid_begins(const grid_axis *x, int block) { return fma(x->plane[4 * block], x->inverse, x->near_offset); }
EC_FN float grid_ends(const grid_axis *x, int block) { return fma(x->plane[4 * block], x->inverse, x->far_offset) * EC_SLAB_PAD; }

/* Returns when the block after `block` begins; never, after the last one. */
EC_FN float grid_next(const grid_axis *x, int block) { return block == x->end ? INFINITY : grid_begins(x, block); }

/* Makes an axis, and narrows *enter and *leave to the ray's way through the whole grid along it. grid_axis_start finds its blocks at t = start from a
 * guess. */
EC_FN void grid_axis_make(grid_axis *x, global const float *planes, int blocks, float inverse, float lo_offset, float hi_offset,
                          int stride, float *enter, float *leave)
{
    bool down = inverse < 0.0f;
    x->plane = planes + (down ? 0 : 4);
    x->inverse = inverse;
    x->near_offset = down ? hi_offset : lo_offset;
    x->far_offset = down ? lo_offset : hi_offset;
    x->step = down ? -1 : 1;
    x->stride = down ? -stride : stride;
    x->end = down ? 0 : blocks - 1;
    *enter = max(*enter, fma(planes[down ? 4 * blocks : 0], inverse, x->near_offset));
    *leave = min(*leave, grid_ends(x, x->end));
}
EC_FN void grid_axis_start(grid_axis *x, int blocks, float guess, float start)
{
    int block = (int)fmin(fmax(guess, 0.0f), (float)(blocks - 1)), first = x->end == 0 ? blocks - 1 : 0;
    while (block != x->end && grid_begins(x, block) <= start) block += x->step;
    while (block != first && grid_begins(x, block - x->step) > start) block -= x->step;
    x->newest = block;
    x->begins = grid_next(x, block);
    while (block != first && grid_ends(x, block - x->step) >= start) block -= x->step;
    x->oldest = block;
    x->ends = grid_ends(x, block);
}

#define GRID_ROW(k, axis)                                                                          \
    ((float8)(t0[4 * (k) + (axis)], t1[4 * (k) + (axis)], t2[4 * (k) + (axis)], t3[4 * (k) + (axis)],              \
              t4[4 * (k) + (axis)], t5[4 * (k) + (axis)], t6[4 * (k) + (axis)], t7[4 * (k) + (axis)]))
#define GRID_SHEARED(k) ray8_shear(q, GRID_ROW(k, q->axis_x), GRID_ROW(k, q->axis_y), GRID_ROW(k, q->axis_z))
#define GRID_SPAN(op, axis) op(GRID_ROW(0, axis), op(GRID_ROW(1, axis), GRID_ROW(2, axis)))

#define GRID_CORNER(k) v3_make(GRID_ROW(k, 0), GRID_ROW(k, 1), GRID_ROW(k, 2))

#define GRID_BOX(k) global const ec_box *b##k = boxes + mail_box[k];
#define GRID_SIDE(s, axis) (float8)(b0->s[axis], b1->s[axis], b2->s[axis], b3->s[axis], b4->s[axis], b5->s[axis], b6->s[axis], b7->s[axis])
#define GRID_BOXES(lo_, hi_)                                                                       \
    {                                                                                              \
        const uint *mail_box = mail->pending;                                                      \
        GRID_BOX(0) GRID_BOX(1) GRID_BOX(2) GRID_BOX(3) GRID_BOX(4) GRID_BOX(5) GRID_BOX(6) GRID_BOX(7) \
        lo_ = v3_make(GRID_SIDE(lo, 0), GRID_SIDE(lo, 1), GRID_SIDE(lo, 2));                       \
        hi_ = v3_make(GRID_SIDE(hi, 0), GRID_SIDE(hi, 1), GRID_SIDE(hi, 2));                       \
    }

/* Tests the pending triangles, gathered from wherever they lie; free places repeat the first. */
EC_FN void grid_test(grid_mail *mail, const ray8 *q, const hit_filter *filter, global const ec_tri *tris,
                     global const ec_box *boxes, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    TALLY_TESTS(h, mail->count);
    for (uint k = mail->count; k < 8u; k++) mail->pending[k] = mail->pending[0];
    mail->count = 0;
#define GRID_TRIANGLE(k) global const float *t##k = (global const float *)(tris + mail->pending[k]);
    EACH_LANE(GRID_TRIANGLE)
#undef GRID_TRIANGLE
    uint8 id = as_uint8(GRID_ROW(0, 3));
    if (block8_moves(filter, id)) { /* there are always boxes then */
        v3 lo, hi;
        GRID_BOXES(lo, hi)
        block8_moving(q, filter, GRID_CORNER(0), GRID_CORNER(1), GRID_CORNER(2), lo, hi, id, skip0, skip1, any_hit, h);
        return;
    }
    edges e = edges_make(GRID_SHEARED(0), GRID_SHEARED(1), GRID_SHEARED(2));
    int8 close;
    float8 t, inverse;
    int8 m = eight_meet(q, &e, id, skip0, skip1, h, &close, &t, &inverse);
    if (!mask_bits8(m)) return;
    if (mask_bits8(close)) {
        t = edges_settle(&q->r, &e, GRID_SHEARED(0), GRID_SHEARED(1), GRID_SHEARED(2), close, inverse, t);
        m = m & (t > 0.0f);
    }
    v3 lo = v3_make(GRID_SPAN(min, 0), GRID_SPAN(min, 1), GRID_SPAN(min, 2));
    v3 hi = v3_make(GRID_SPAN(max, 0), GRID_SPAN(max, 1), GRID_SPAN(max, 2));
    if (boxes) {
        GRID_BOXES(lo, hi)
    }
    eight_take(q, filter, &e, m, id, t, inverse, lo, hi, any_hit, h);
}

EC_FN void grid_visit(grid_mail *mail, global const uint *entries, uint first, uint end, const ray8 *q, const hit_filter *filter,
                      global const ec_tri *tris, global const ec_box *boxes, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    for (uint i = first; i < end; i++) {
        uint which = entries[i];
        if (mail->seen[which % GRID_MAIL] == which) continue;
        mail->seen[which % GRID_MAIL] = which;
        mail->pending[mail->count++] = which;
        if (mail->count == 8u) grid_test(mail, q, filter, tris, boxes, skip0, skip1, any_hit, h);
    }
}

/* Computes when the ray enters and leaves each of the four cells of a block along an axis. */
EC_FN void grid_four(const grid_axis *x, int block, float4 *begins, float4 *ends)
{
    bool down = x->step < 0;
    global const float *planes = x->plane - (down ? 0 : 4) + 4 * block;
    float4 lo = vload4(0, planes), hi = vload4(0, planes + 1);
    *begins = fma(down ? hi : lo, (float4)(x->inverse), (float4)(x->near_offset));
    *ends = fma(down ? lo : hi, (float4)(x->inverse), (float4)(x->far_offset)) * EC_SLAB_PAD;
}

/* Returns a bit for each cell of block (bx, by, bz) that the ray meets before t_max. */
EC_FN ulong grid_cells(const grid_axis *axis, int bx, int by, int bz, float t_max)
{
    float4 x0, x1, y0, y1, z0, z1;
    grid_four(&axis[0], bx, &x0, &x1);
    grid_four(&axis[1], by, &y0, &y1);
    grid_four(&axis[2], bz, &z0, &z1);
    x0 = max(x0, (float4)(0.0f));
    x1 = min(x1, (float4)(t_max));
    float8 low0 = max(x0.s01230123, y0.s00001111), low1 = min(x1.s01230123, y1.s00001111);
    float8 high0 = max(x0.s01230123, y0.s22223333), high1 = min(x1.s01230123, y1.s22223333);
    ulong bits = 0;
#define GRID_LAYER(k)                                                                              \
    bits |= (ulong)(mask_bits8(max(low0, (float8)(z0.s##k)) <= min(low1, (float8)(z1.s##k))) |     \
                    mask_bits8(max(high0, (float8)(z0.s##k)) <= min(high1, (float8)(z1.s##k))) << 8) << (16 * k);
    GRID_LAYER(0)
    GRID_LAYER(1)
    GRID_LAYER(2)
    GRID_LAYER(3)
#undef GRID_LAYER
    return bits;
}

EC_FN void grid_trace(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    global const ec_grid *grid = a->at[0];
    global const ec_grid_block *blocks = a->at[1];
    global const ec_tri *tris = a->at[3];
    global const ec_box *boxes = a->at[4];
    global const float *planes = (global const float *)(grid + 1);
    const int nx = (int)grid->blocks[0], ny = (int)grid->blocks[1], nz = (int)grid->blocks[2];
    global const float *planes_y = planes + 4 * nx + 1, *planes_z = planes_y + 4 * ny + 1;
    global const uint *starts = a->at[2], *entries = starts + grid->start_count;
    const ray *r = &q->r;
    grid_axis axis[3];
    float now = 0.0f, leave = h->t;
    grid_axis_make(&axis[0], planes, nx, r->inverse.x.s0, r->lo_offset.x.s0, r->hi_offset.x.s0, 1, &now, &leave);
    grid_axis_make(&axis[1], planes_y, ny, r->inverse.y.s0, r->lo_offset.y.s0, r->hi_offset.y.s0, nx, &now, &leave);
    grid_axis_make(&axis[2], planes_z, nz, r->inverse.z.s0, r->lo_offset.z.s0, r->hi_offset.z.s0, nx * ny, &now, &leave);
    if (!(now <= leave)) return;
    grid_axis_start(&axis[0], nx, (fma(now, r->d.x.s0, r->o.x.s0) - planes[0]) * grid->per_unit[0], now);
    grid_axis_start(&axis[1], ny, (fma(now, r->d.y.s0, r->o.y.s0) - planes_y[0]) * grid->per_unit[1], now);
    grid_axis_start(&axis[2], nz, (fma(now, r->d.z.s0, r->o.z.s0) - planes_z[0]) * grid->per_unit[2], now);

    grid_mail mail;
    for (uint k = 0; k < GRID_MAIL; k++) mail.seen[k] = EC_NO_ID;
    mail.count = 0;
    int block = axis[0].newest + nx * (axis[1].newest + ny * axis[2].newest);
    int x = 0, u = 1, v = 2; /* the axis of the step, the two others */
    int at[3];               /* the block being visited */
    at[0] = axis[0].oldest;  /* at the start all blocks are new, and after a step the newest */
    for (;;) {
        int along = block - (axis[x].newest - at[x]) * axis[x].step * axis[x].stride;
        for (;; along += axis[x].stride, at[x] += axis[x].step) {
            int row = along;
            for (at[u] = axis[u].newest;; at[u] -= axis[u].step, row -= axis[u].stride) {
                int one = row;
                for (at[v] = axis[v].newest;; at[v] -= axis[v].step, one -= axis[v].stride) {
                    global const ec_grid_block *b = blocks + one;
                    ulong occupied = upsample(b->occupied[1], b->occupied[0]);
                    TALLY_NODE(h);
                    if (occupied) {
                        ulong cells = occupied & grid_cells(axis, at[0], at[1], at[2], h->t);
                        for (; cells; cells &= cells - 1) {
                            ulong below = (cells & -cells) - 1;
                            global const uint *start = starts + b->first + (uint)popcount(occupied & below);
                            TALLY_NODE(h);
                            grid_visit(&mail, entries, start[0], start[1], q, filter, tris, boxes, skip0, skip1, any_hit, h);
                        }
                    }
                    if (at[v] == axis[v].oldest) break;
                }
                if (at[u] == axis[u].oldest) break;
            }
            if (along == block) break;
        }
        if (mail.count) grid_test(&mail, q, filter, tris, boxes, skip0, skip1, any_hit, h);
        if (any_hit && h->prim != EC_NO_ID) return;

        x = axis[0].begins < axis[1].begins ? 0 : 1;
        x = axis[x].begins <= axis[2].begins ? x : 2;
        u = x == 0 ? 1 : 0;
        v = x == 2 ? 1 : 2;
        now = axis[x].begins;
        if (now > min(leave, h->t)) return;
        axis[x].newest += axis[x].step;
        axis[x].begins = grid_next(&axis[x], axis[x].newest);
        block += axis[x].stride;
        at[x] = axis[x].newest;
        while (axis[u].ends < now) {
            axis[u].oldest += axis[u].step;
            axis[u].ends = grid_ends(&axis[u], axis[u].oldest);
        }
        while (axis[v].ends < now) {
            axis[v].oldest += axis[v].step;
            axis[v].ends = grid_ends(&axis[v], axis[v].oldest);
        }
    }
}

#define ACCEL grid
#define ACCEL_HAS_TRACE
#include "trace_rays.h"
#undef ACCEL_HAS_TRACE
#undef ACCEL

#endif
