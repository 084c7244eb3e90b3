/* A triangle's interpolated attributes. A stream the scene does not have is NULL: specialised kernels lack the code that
 * reads it, universal ones look at the pointer. */
#ifndef EC_LIB_GEOMETRY_H
#define EC_LIB_GEOMETRY_H

#include "texture.h"

typedef struct geometry {
    global const float *prims;     /* ec_prim by word */
    global const uint *indices;    /* 3 a triangle */
    global const float *normals;   /* 3 a vertex, or 0 */
    global const float *tangents;  /* 4 a vertex, or 0 */
    global const float *uv0, *uv1; /* 2 a vertex, or 0 */
    global const float *colors;    /* 4 a vertex, or 0 */
    global const float *materials; /* ec_material_data by word */
    textures tex;
} geometry;

/* What the surface look-ups share: which triangle, where on it, what it is made of. Off lanes hold triangle 0. */
typedef struct hit_point {
    lane_u prim;
    lane_f b0, b1, b2;
    lane_u i0, i1, i2;   /* vertex indices; set when any attribute is needed */
    lane_f u0, v0, u1, v1; /* both uv sets */
    lane_u material;     /* first word of its material */
} hit_point;

#define HAS_TEXTURES                                                                               \
    (HAS(BASE_COLOR_TEXTURE) || HAS(METALLIC_ROUGHNESS_TEXTURE) || HAS(NORMAL_TEXTURE) ||          \
     HAS(EMISSION_TEXTURE) || HAS(SPECULAR_TEXTURE))
#define HAS_ATTRIBUTES (HAS_TEXTURES || HAS(SMOOTH_NORMALS) || HAS(VERTEX_COLORS))

EC_FN lane_f interpolate(global const float *stream, uint width, uint component, const hit_point *h)
{
    return fma(gather_f(stream, h->i2 * width + component), h->b2,
               fma(gather_f(stream, h->i1 * width + component), h->b1,
                   gather_f(stream, h->i0 * width + component) * h->b0));
}

EC_FN hit_point hit_point_make(const geometry *g, lane_u prim, lane_f b1, lane_f b2)
{
    hit_point h;
    h.prim = prim;
    h.b0 = 1.0f - b1 - b2;
    h.b1 = b1;
    h.b2 = b2;
    h.material = as_lane_u(gather_f(g->prims, prim * EC_PRIM_WORDS + 3u)) * EC_MATERIAL_WORDS;
    h.i0 = h.i1 = h.i2 = U(0);
    h.u0 = h.v0 = h.u1 = h.v1 = F(0.0f);
    if (HAS_ATTRIBUTES && g->indices) {
        h.i0 = gather_u(g->indices, prim * 3u);
        h.i1 = gather_u(g->indices, prim * 3u + 1u);
        h.i2 = gather_u(g->indices, prim * 3u + 2u);
    }
    if (HAS_TEXTURES) {
        if (g->uv0) {
            h.u0 = interpolate(g->uv0, 2, 0, &h);
            h.v0 = interpolate(g->uv0, 2, 1, &h);
        }
        if (g->uv1) {
            h.u1 = interpolate(g->uv1, 2, 0, &h);
            h.v1 = interpolate(g->uv1, 2, 1, &h);
        }
    }
    return h;
}

EC_FN lane_f material_word(const geometry *g, const hit_point *h, uint word)
{
    return gather_f(g->materials, h->material + word);
}
EC_FN v3 material_v3(const geometry *g, const hit_point *h, uint word)
{
    return v3_make(material_word(g, h, word), material_word(g, h, word + 1), material_word(g, h, word + 2));
}

/* A material's texture at the hit; white where it has none. */
EC_FN rgba material_texture(const geometry *g, const hit_point *h, lane_i m, uint slot, bool is_srgb)
{
    uint base = EC_MATERIAL_SLOTS + slot * 8u;
    lane_i id = uint_to_lane_i(as_lane_u(material_word(g, h, base)));
    m = m & (id >= 0);
    rgba white = {v3_splat(F(1.0f)), F(1.0f)};
    if (!any_lane(m)) return white;
    lane_i second = as_lane_u(material_word(g, h, base + 1)) != 0u;
    lane_f u = second ? h->u1 : h->u0, v = second ? h->v1 : h->v0;
    lane_f tu = fma(material_word(g, h, base + 2), u, fma(material_word(g, h, base + 3), v, material_word(g, h, base + 4)));
    lane_f tv = fma(material_word(g, h, base + 5), u, fma(material_word(g, h, base + 6), v, material_word(g, h, base + 7)));
    return texture_sample(g->tex, m, id, tu, tv, is_srgb);
}

/* Base colour and coverage. */
EC_FN rgba surface_base_color(const geometry *g, const hit_point *h, lane_i m)
{
    rgba r = {material_v3(g, h, EC_MATERIAL_BASE_COLOR), material_word(g, h, EC_MATERIAL_BASE_COLOR + 3)};
    if (HAS(BASE_COLOR_TEXTURE)) {
        rgba t = material_texture(g, h, m, EC_SLOT_BASE_COLOR, true);
        r.rgb = v3_mul(r.rgb, t.rgb);
        r.a *= t.a;
    }
    if (HAS(VERTEX_COLORS) && g->colors) {
        v3 c = v3_make(interpolate(g->colors, 4, 0, h), interpolate(g->colors, 4, 1, h), interpolate(g->colors, 4, 2, h));
        r.rgb = v3_mul(r.rgb, c);
        r.a *= interpolate(g->colors, 4, 3, h);
    }
    return r;
}

/* Radiance leaving the front (a double-sided material: both sides). */
EC_FN v3 surface_emission(const geometry *g, const hit_point *h, lane_i m)
{
    v3 e = material_v3(g, h, EC_MATERIAL_EMISSION);
    if (HAS(EMISSION_TEXTURE)) e = v3_mul(e, material_texture(g, h, m, EC_SLOT_EMISSION, true).rgb);
    return e;
}

#endif
