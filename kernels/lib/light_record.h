/* The table of lights, and a light of it. */
#ifndef EC_LIB_LIGHT_RECORD_H
#define EC_LIB_LIGHT_RECORD_H

#include "environment.h"
#include "geometry.h"
#include "motion.h"

typedef struct lights {
    global const float *table; /* ec_light_data by word */
    global const uint *shares; /* ec_distribution_entry by word, one for each light of the table; with a tree, one for each light at infinity, which
                                * come first, and one for all others together */
    environment env;
    global const float *tree;  /* ec_light_node by word; NULL: lights are chosen by power alone */
    global const uint *emission; /* with LIGHT_PATHS: how lights are chosen as their start (light_path.h) */
} lights;

EC_FN bool lights_have_tree(const lights *l) { return HAS(LIGHT_TREE) && l->tree; }

/* One light's 16 words. */
typedef struct light_record {
    v3 a, b, c, emission;
    lane_u kind, prim;
    lane_f pmf, pdf_a;
} light_record;

EC_FN light_record light_load(const lights *l, lane_u id)
{
    lane_u at = id * EC_LIGHT_WORDS;
    quad q0 = gather_quad(l->table, at), q1 = gather_quad(l->table, at + 4u), q2 = gather_quad(l->table, at + 8u),
         q3 = gather_quad(l->table, at + 12u);
    light_record r = {v3_make(q0.a, q0.b, q0.c), v3_make(q0.d, q1.a, q1.b), v3_make(q1.c, q1.d, q2.a),
                      v3_make(q2.b, q2.c, q2.d), as_lane_u(q3.a), as_lane_u(q3.b), q3.c, q3.d};
    return r;
}

/* Moves a light to where it is at the paths' time. Lanes whose light stands still load a valid key, which is not used. */
EC_FN void light_move(const geometry *g, light_record *l)
{
    lane_u type = l->kind & EC_LIGHT_KIND_MASK;
    lane_i moves = (l->kind & EC_LIGHT_MOVES) != 0u, punctual = moves & (type != EC_KIND_TRIANGLE), triangle = moves & !punctual;
    if (HAS(AREA_LIGHTS) && any_lane(triangle)) {
        motion_corners(g->motion, g->time, triangle, l->prim, &l->a, &l->b, &l->c);
        l->pdf_a = triangle ? l->pdf_a * motion_per_area(l->a, l->b, l->c) : l->pdf_a;
    }
    if (HAS(PUNCTUAL_LIGHTS) && any_lane(punctual)) {
        moment t = moment_of(g->motion, g->time);
        lane_u light = punctual ? l->prim * 2u : U(0);
        l->a = v3_select(punctual, motion_point(g->motion, EC_MOTION_LIGHTS, light, t), l->a);
        l->b = v3_select(punctual, v3_normalize(motion_point(g->motion, EC_MOTION_LIGHTS, light + 1u, t)), l->b);
    }
}

/* Loads one light for all lanes. */
EC_FN light_record light_load_one(global const float *table, uint id)
{
    global const float *p = table + id * EC_LIGHT_WORDS;
    light_record r = {v3_make(F(p[0]), F(p[1]), F(p[2])), v3_make(F(p[3]), F(p[4]), F(p[5])), v3_make(F(p[6]), F(p[7]), F(p[8])),
                      v3_make(F(p[9]), F(p[10]), F(p[11])), U(as_uint(p[12])), U(as_uint(p[13])), F(p[14]), F(p[15])};
    return r;
}

#endif
