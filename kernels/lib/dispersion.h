/* Dispersion in glass (KHR_materials_dispersion). Red, green and blue have an index each, by the first two terms of Cauchy's formula at the lines C,
 * d and F (656.3, 587.6, 486.1 nm), where n_F - n_C = (n_d - 1) / V and the Abbe number V is 20 / dispersion. A path that meets such glass goes on in
 * one channel, chosen by its share of the throughput, and carries the sum of all three in it from then on. */
#ifndef EC_LIB_DISPERSION_H
#define EC_LIB_DISPERSION_H

#include "choice.h"
#include "surface.h"

/* Returns the index of channel 0, 1 or 2. place: (1 / l^2 - 1 / l_d^2) / (1 / l_F^2 - 1 / l_C^2) for the channel's line l. */
EC_FN lane_f dispersed_index(lane_f ior, lane_f dispersion, lane_i channel)
{
    lane_f place = channel == 0 ? F(-0.300782194f) : (channel == 1 ? F(0.0f) : F(0.699217806f));
    return max(fma((ior - 1.0f) * 0.05f * dispersion, place, ior), F(1.0f));
}

/* Chooses a channel of beta by *u, never one that is 0, and returns it. *left: that channel, with the sum of all. *u is rescaled to be reused. */
EC_FN lane_i dispersion_choose(v3 beta, lane_f *u, v3 *left)
{
    lane_f sum = beta.x + beta.y + beta.z, at = *u * sum;
    lane_i red = (at < beta.x) | (beta.y + beta.z == 0.0f), green = (!red) & ((at < beta.x + beta.y) | (beta.z == 0.0f));
    green = green & (beta.y > 0.0f);
    *left = v3_make(red ? sum : F(0.0f), green ? sum : F(0.0f), (red | green) ? F(0.0f) : sum);
    lane_f rest = red ? at / beta.x : (green ? (at - beta.x) / beta.y : (at - beta.x - beta.y) / beta.z);
    *u = min(max(rest, F(0.0f)), F(EC_LAST_UNIT));
    return red ? I(0) : (green ? I(1) : I(2));
}

/* Sets the surface's index to that of one channel, and *beta to that channel, where there is such glass. *u chooses there, and is rescaled to be reused. */
EC_FN void disperse(const geometry *g, const hit_point *h, lane_i m, lane_f *u, surface *s, v3 *beta)
{
    quad q = material_quad(g, h, EC_WORD_ior);
    m = m & s->refracts & !s->displaced & (s->transmission > 0.0f) & (q.b > 0.0f) & (q.a > 1.0f) & (v3_max_component(*beta) > 0.0f);
    if (!any_lane(m)) return;
    v3 left;
    lane_f rest = *u, ior = dispersed_index(q.a, q.b, dispersion_choose(*beta, &rest, &left));
    *u = m ? rest : *u;
    lane_f r = (ior - 1.0f) * (q.a + 1.0f) / ((ior + 1.0f) * (q.a - 1.0f)), eta = s->front ? ior : 1.0f / ior;
    if (HAS(NESTED)) { /* relative to the medium on the other side, whose index is the same for all channels */
        lane_i nested = s->head_on < 1.0f;
        lane_f between = s->eta * (s->front ? ior / q.a : q.a / ior), r_between = (between - 1.0f) / (between + 1.0f);
        lane_f r_all = (s->eta - 1.0f) / (s->eta + 1.0f);
        lane_i alike = nested & (r_all == 0.0f);
        s->f0 = v3_select(m & alike, v3_splat(s->f90), s->f0);
        r = nested ? (alike ? r_between : r_between / r_all) : r;
        eta = nested ? between : eta;
    }
    *beta = v3_select(m, left, *beta);
    s->eta = m ? eta : s->eta;
    /* Channels of f0 that are limited to f90 stay so. */
    v3 f0 = v3_scale(s->f0, r * r);
    s->f0 = v3_select(m, v3_make(min(f0.x, s->f90), min(f0.y, s->f90), min(f0.z, s->f90)), s->f0);
    if (HAS(ANISOTROPY)) surface_widen(m, s);
    if (HAS(SMOOTH)) s->smooth = s->smooth | (m & (s->stretch == 1.0f) & surface_passes_singly(s));
}

#endif
