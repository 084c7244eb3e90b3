/* Parts of lamps whose textures vary: small triangles where they do, large ones elsewhere, each chosen by the light it emits (host/pack/lamp_parts.c). An
 * eighth of the samples goes to the lamp as a whole, since a part's share ignores how near it is, what its texture's filter takes from beside it, and alpha.
 * With that eighth the second moment is at most eight times that of a lamp in one piece, and no point's density is 0. */
#ifndef EC_LIB_LAMP_PARTS_H
#define EC_LIB_LAMP_PARTS_H

#include "../shared/features.h"
#include "../shared/scene_buffers.h"
#include "choice.h"
#include "math.h"

#define EC_LAMP_WHOLE 0.125f /* share of the numbers from EC_LAMP_PARTS_NUMBERS on */

typedef struct lamp_part {
    lane_f b1, b2; /* barycentrics of its first corner on the lamp */
    lane_f size;   /* its edges over the lamp's; below 0 for parts that are turned */
    lane_u first, share; /* numbers that choose it: the first, and how many */
} lamp_part;

EC_FN lamp_part lamp_part_all(void)
{
    lamp_part all = {F(0.0f), F(0.0f), F(1.0f), U(0), U(EC_LAMP_PARTS_NUMBERS)};
    return all;
}

/* Narrows *part to one of its four children, on the lanes m. */
EC_FN void lamp_part_enter(lamp_part *part, lane_i m, quad node, lane_u child)
{
    lane_u second = as_lane_u(node.a), third = as_lane_u(node.b), fourth = as_lane_u(node.c), end = part->first + part->share;
    lane_u first = child == 0u ? part->first : child == 1u ? second : child == 2u ? third : fourth;
    lane_u next = child == 0u ? second : child == 1u ? third : child == 2u ? fourth : end;
    lane_f half_size = 0.5f * part->size;
    part->b1 += (m & ((child & 1u) != 0u)) ? half_size : F(0.0f);
    part->b2 += (m & (child >= 2u)) ? half_size : F(0.0f);
    part->size = m ? (child == 3u ? -half_size : half_size) : part->size;
    part->share = m ? next - first : part->share;
    part->first = m ? first : part->first;
}

/* Descends from a lamp's first node, on the lanes m, to the part that number r chooses (by_number), or to that of the point (b1, b2). */
EC_FN lamp_part lamp_part_descend(global const float *nodes, lane_i m, lane_u node, bool by_number, lane_u r, lane_f b1, lane_f b2)
{
    lamp_part part = lamp_part_all();
    node = m ? node : U(0);
    while (any_lane(m)) {
        quad q = gather_quad(nodes, node * EC_LAMP_NODE_WORDS);
        lane_u child;
        if (by_number) {
            child = (r >= as_lane_u(q.a) ? U(1) : U(0)) + (r >= as_lane_u(q.b) ? U(1) : U(0)) + (r >= as_lane_u(q.c) ? U(1) : U(0));
        } else {
            lane_f scale = 1.0f / part.size, x = (b1 - part.b1) * scale, y = (b2 - part.b2) * scale;
            child = x >= 0.5f ? U(1) : y >= 0.5f ? U(2) : x + y >= 0.5f ? U(3) : U(0);
        }
        lamp_part_enter(&part, m, q, child);
        lane_u link = as_lane_u(q.d), before = link & ((U(1) << child) - 1u);
        m = m & (((link >> child) & 1u) != 0u);
        node = m ? (link >> 4) + (before & 1u) + ((before >> 1) & 1u) + ((before >> 2) & 1u) : U(0);
    }
    return part;
}

/* Returns the density by area of samples of the part, over that of samples of the whole. */
EC_FN lane_f lamp_part_density(const lamp_part *part)
{
    return to_lane_f(part->share) * (1.0f / 4294967296.0f) / (part->size * part->size);
}

/* Replaces the lamp's corners by the part's; for the whole they stay, bit for bit. */
EC_FN void lamp_part_corners(const lamp_part *part, v3 *a, v3 *b, v3 *c)
{
    lane_i is_all = part->size == 1.0f;
    v3 e = v3_sub(*b, *a), f = v3_sub(*c, *a), corner = v3_fma(f, part->b2, v3_fma(e, part->b1, *a));
    *a = v3_select(is_all, *a, corner);
    *b = v3_select(is_all, *b, v3_fma(e, part->size, corner));
    *c = v3_select(is_all, *c, v3_fma(f, part->size, corner));
}

/* Chooses by the 32-bit number r, on the lanes m, a part or the whole of the lamp. *left: where r lies among the numbers that choose it, in [0, 1). */
EC_FN lamp_part lamp_part_choose(global const float *nodes, lane_i m, lane_u node, lane_u r, lane_f *left)
{
    lane_i parted = m & (r < EC_LAMP_PARTS_NUMBERS);
    lamp_part part = lamp_part_descend(nodes, parted, node, true, r, F(0.0f), F(0.0f));
    lane_u first = parted ? part.first : U(EC_LAMP_PARTS_NUMBERS), share = parted ? part.share : U(0u - EC_LAMP_PARTS_NUMBERS);
    *left = choice_rest(r - first, share, r);
    return part;
}

#endif
