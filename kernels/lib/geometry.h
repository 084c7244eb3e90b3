/* A triangle's interpolated attributes. A stream the scene does not have is NULL: specialised kernels lack the code that
 * reads it, universal ones look at the pointer. */
#ifndef EC_LIB_GEOMETRY_H
#define EC_LIB_GEOMETRY_H

#include "instance.h"
#include "motion.h"
#include "texture.h"

typedef struct geometry {
    global const float *prims;     /* ec_prim by word */
    global const float *indices;   /* uints, 3 a triangle, or 0 */
    global const float *normals;   /* 3 a vertex, or 0 */
    global const float *tangents;  /* 4 a vertex, or 0 */
    global const float *uvs;       /* 4 a vertex: both uv sets, or 0 */
    global const float *colors;    /* 4 a vertex, or 0 */
    global const float *materials; /* ec_material_data by word */
    textures tex;
    global const float *places;    /* of instances, or 0 */
    global const float *motion;    /* what moves, or 0 */
    lane_f time;                   /* with MOTION: times of the paths */
    global const float *parts;     /* ec_lamp_node by word, or 0 */
} geometry;

/* The hit that the surface look-ups share: its triangle, the place on it, its material. Off lanes hold triangle 0. */
typedef struct hit_point {
    v3 p0, p1, p2;       /* its vertices */
    lane_f b0, b1, b2;
    lane_u i0, i1, i2;   /* vertex indices; set when any attribute is needed */
    quad uv, uv0, uv1, uv2; /* both uv sets: at the hit, at the vertices */
    lane_u material;     /* first word of its material */
    bool is_one_material; /* with textures: all lanes have the same material, so one load serves them */
    lane_f light_pdf_a;
    lane_u parts;        /* with LAMP_PARTS: the first node of its parts, or 0 */
    lane_i placed;       /* with INSTANCES: the triangle belongs to an instance, … */
    lane_u place;        /* … whose ec_place is at this word */
    lane_i turned;       /* … which is mirrored */
} hit_point;

EC_FN lane_f interpolate(const hit_point *h, lane_f v0, lane_f v1, lane_f v2)
{
    return fma(v2, h->b2, fma(v1, h->b1, v0 * h->b0));
}

EC_FN quad interpolate_quad(const hit_point *h, quad v0, quad v1, quad v2)
{
    quad q = {interpolate(h, v0.a, v1.a, v2.a), interpolate(h, v0.b, v1.b, v2.b), interpolate(h, v0.c, v1.c, v2.c),
              interpolate(h, v0.d, v1.d, v2.d)};
    return q;
}

/* Interpolates the first four words of a stream of `width` words a vertex. */
EC_FN quad interpolate_stream(global const float *stream, uint width, const hit_point *h)
{
    return interpolate_quad(h, gather_quad(stream, h->i0 * width), gather_quad(stream, h->i1 * width),
                            gather_quad(stream, h->i2 * width));
}

/* Returns the index of a triangle's ec_prim. */
EC_FN lane_u geometry_prim(const geometry *g, lane_u prim)
{
    lane_i placed, turned;
    lane_u place;
    return HAS(INSTANCES) && g->places ? instance_find(g->places, prim, &placed, &place, &turned) : prim;
}

/* Transforms a vertex's direction d to the world. word: as in instance_direction. */
EC_FN v3 hit_direction(const geometry *g, const hit_point *h, uint word, v3 d)
{
    if (!HAS(INSTANCES) || !g->places || !any_lane(h->placed)) return d;
    return v3_select(h->placed, instance_direction(g->places, h->place, word, d), d);
}

EC_FN void exchange(lane_i m, lane_u *a, lane_u *b)
{
    lane_u first = *a;
    *a = m ? *b : first;
    *b = m ? first : *b;
}

EC_INLINED hit_point hit_point_make(const geometry *g, lane_u prim, lane_f b1, lane_f b2)
{
    hit_point h;
    h.placed = h.turned = !TRUE_MASK;
    h.place = U(0);
    if (HAS(INSTANCES) && g->places) prim = instance_find(g->places, prim, &h.placed, &h.place, &h.turned);
    quad v0 = gather_quad(g->prims, prim * EC_PRIM_WORDS), v1 = gather_quad(g->prims, prim * EC_PRIM_WORDS + 4u),
         v2 = gather_quad(g->prims, prim * EC_PRIM_WORDS + 8u);
    h.p0 = v3_make(v0.a, v0.b, v0.c);
    h.p1 = v3_make(v1.a, v1.b, v1.c);
    h.p2 = v3_make(v2.a, v2.b, v2.c);
    h.material = as_lane_u(v0.d) * EC_MATERIAL_WORDS;
    h.is_one_material = HAS_TEXTURES && all_same(h.material);
    h.light_pdf_a = v1.d;
    h.parts = HAS(LAMP_PARTS) ? as_lane_u(v2.d) >> EC_PRIM_PARTS : U(0);
    if (HAS(INSTANCES) && any_lane(h.placed)) instance_corners(g->places, h.placed, h.turned, h.place, &h.p0, &h.p1, &h.p2);
    if (HAS(MOTION) && g->motion) {
        lane_i moves = motion_moves(g->motion, prim) & !h.placed;
        if (any_lane(moves)) {
            motion_corners(g->motion, g->time, moves, prim, &h.p0, &h.p1, &h.p2);
            h.light_pdf_a = moves ? h.light_pdf_a * motion_per_area(h.p0, h.p1, h.p2) : h.light_pdf_a;
        }
    }
    h.b0 = 1.0f - b1 - b2;
    h.b1 = b1;
    h.b2 = b2;
    h.i0 = h.i1 = h.i2 = U(0);
    quad none = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    h.uv = h.uv0 = h.uv1 = h.uv2 = none;
    if (HAS_ATTRIBUTES && g->indices) {
        quad i = gather_quad(g->indices, prim * 3u);
        h.i0 = as_lane_u(i.a);
        h.i1 = as_lane_u(i.b);
        h.i2 = as_lane_u(i.c);
        if (HAS(INSTANCES)) exchange(h.turned, &h.i1, &h.i2);
    }
    if (HAS_UV && g->uvs) {
        h.uv0 = gather_quad(g->uvs, h.i0 * 4u);
        h.uv1 = gather_quad(g->uvs, h.i1 * 4u);
        h.uv2 = gather_quad(g->uvs, h.i2 * 4u);
        h.uv = interpolate_quad(&h, h.uv0, h.uv1, h.uv2);
    }
    return h;
}

EC_FN v3 vertex_normal(const geometry *g, const hit_point *h, lane_u vertex)
{
    quad q = gather_quad(g->normals, vertex * 3u);
    v3 n = v3_make(q.a, q.b, q.c);
    if (HAS(MOTION) && g->motion) n = motion_direction(g->motion, g->time, EC_MOTION_NORMALS, vertex, n);
    return hit_direction(g, h, EC_PLACE_NORMAL, n);
}

EC_FN v3 interpolate_v3(const hit_point *h, v3 v0, v3 v1, v3 v2)
{
    return v3_make(interpolate(h, v0.x, v1.x, v2.x), interpolate(h, v0.y, v1.y, v2.y), interpolate(h, v0.z, v1.z, v2.z));
}

EC_FN v3 interpolate_normal(const geometry *g, const hit_point *h)
{
    return interpolate_v3(h, vertex_normal(g, h, h->i0), vertex_normal(g, h, h->i1), vertex_normal(g, h, h->i2));
}

EC_FN v3 vertex_tangent(const geometry *g, const hit_point *h, lane_u vertex, lane_f *hand)
{
    quad q = gather_quad(g->tangents, vertex * 4u);
    v3 t = v3_make(q.a, q.b, q.c);
    *hand = q.d;
    if (HAS(MOTION) && g->motion) t = motion_direction(g->motion, g->time, EC_MOTION_TANGENTS, vertex, t);
    return hit_direction(g, h, 0u, t);
}

/* *hand: its sign gives the direction of the bitangent. A mirrored mesh's changes sign, since n x t is not mirrored. */
EC_FN v3 interpolate_tangent(const geometry *g, const hit_point *h, lane_f *hand)
{
    lane_f hand0, hand1, hand2;
    v3 t0 = vertex_tangent(g, h, h->i0, &hand0), t1 = vertex_tangent(g, h, h->i1, &hand1), t2 = vertex_tangent(g, h, h->i2, &hand2);
    *hand = interpolate(h, hand0, hand1, hand2);
    if (HAS(INSTANCES)) *hand = h->turned ? -*hand : *hand;
    return interpolate_v3(h, t0, t1, t2);
}

EC_FN quad material_quad(const geometry *g, const hit_point *h, uint word)
{
    return gather_quad_if(h->is_one_material, g->materials, h->material + word);
}

/* Returns the entry of texture `id` in the table, valid on the lanes m. */
EC_FN quad texture_entry(const geometry *g, const hit_point *h, lane_i m, lane_i id)
{
    return gather_quad_if(h->is_one_material, g->tex.table, int_to_lane_u(h->is_one_material ? id : m ? id : I(0)) * 4u);
}

/* Samples a material's texture at the hit; white where it has none. */
EC_CALLED rgba material_texture(const geometry *g, const hit_point *h, lane_i m, uint slot, bool is_srgb)
{
    quad head = material_quad(g, h, EC_WORD_slots + slot * 8u);
    lane_i id = uint_to_lane_i(as_lane_u(head.a));
    m = m & (id >= 0);
    rgba white = {v3_splat(F(1.0f)), F(1.0f)};
    if (!any_lane(m)) return white;
    quad tail = material_quad(g, h, EC_WORD_slots + slot * 8u + 4u);
    lane_i second = as_lane_u(head.b) != 0u;
    lane_f u = second ? h->uv.c : h->uv.a, v = second ? h->uv.d : h->uv.b;
    lane_f tu = fma(head.c, u, fma(head.d, v, tail.a)), tv = fma(tail.b, u, fma(tail.c, v, tail.d));
    return texture_sample(g->tex, m, texture_entry(g, h, m, id), tu, tv, is_srgb);
}

/* Base colour and coverage. */
EC_FN rgba surface_base_color(const geometry *g, const hit_point *h, lane_i m)
{
    quad base = material_quad(g, h, EC_WORD_base_color);
    rgba r = {v3_make(base.a, base.b, base.c), base.d};
    if (HAS(BASE_COLOR_TEXTURE)) {
        rgba t = material_texture(g, h, m, EC_SLOT_BASE_COLOR, true);
        r.rgb = v3_mul(r.rgb, t.rgb);
        r.a *= t.a;
    }
    if (HAS(VERTEX_COLORS) && g->colors) {
        quad c = interpolate_stream(g->colors, 4, h);
        r.rgb = v3_mul(r.rgb, v3_make(c.a, c.b, c.c));
        r.a *= c.d;
    }
    return r;
}

/* Returns the share of rays that the point stops: alpha, or 0 or 1 by a cutoff. */
EC_FN lane_f surface_coverage(const geometry *g, const hit_point *h, lane_i m)
{
    lane_f alpha = surface_base_color(g, h, m).a;
    lane_i is_mask = (as_lane_u(material_quad(g, h, EC_WORD_emission).d) & EC_MATERIAL_MASK) != 0u;
    lane_f cutoff = material_quad(g, h, EC_WORD_metallic).d;
    return is_mask ? (alpha >= cutoff ? F(1.0f) : F(0.0f)) : alpha;
}

/* Returns the radiance that leaves the front (of a double-sided material: both sides). emission: the material's words from EC_WORD_emission on. */
EC_FN v3 surface_emission(const geometry *g, const hit_point *h, lane_i m, quad emission)
{
    v3 e = v3_make(emission.a, emission.b, emission.c);
    if (HAS(EMISSION_TEXTURE)) e = v3_mul(e, material_texture(g, h, m, EC_SLOT_EMISSION, true).rgb);
    return e;
}

#endif
