/* Texture look-up. All images lie in one buffer of texels; a texture is a view of one. No minification filter: pixels are
 * supersampled, and a converged image should not depend on one. The host has made every uv finite. */
#ifndef EC_LIB_TEXTURE_H
#define EC_LIB_TEXTURE_H

#include "../shared/features.h"
#include "../shared/scene_buffers.h"
#include "math.h"

typedef struct textures {
    global const float *table;  /* ec_texture_data by word */
    global const uint *texels;
    constant float *srgb;       /* linear value of each sRGB byte */
} textures;

typedef struct rgba {
    v3 rgb;
    lane_f a;
} rgba;

/* One 8-bit texel, linear. Alpha is linear in every encoding. */
EC_INLINED rgba texel_bytes(textures t, lane_u word, bool is_srgb)
{
    rgba r;
    lane_u red = word & 255u, green = (word >> 8) & 255u, blue = (word >> 16) & 255u;
    if (is_srgb)
        r.rgb = v3_make(gather_constant_f(t.srgb, red), gather_constant_f(t.srgb, green),
                        gather_constant_f(t.srgb, blue));
    else
        r.rgb = v3_scale(v3_make(to_lane_f(red), to_lane_f(green), to_lane_f(blue)), F(1.0f / 255.0f));
    r.a = to_lane_f(word >> 24) * (1.0f / 255.0f);
    return r;
}

/* Reads the texels `first` and `second` of a row that starts at `row`. They are mostly neighbours, so one load fetches both; at the end it reads a
 * word more than there are texels. */
EC_INLINED void texture_row(textures t, lane_u offset, lane_u row, lane_u first, lane_u second, lane_i is_float,
                            bool is_srgb, rgba *a, rgba *b)
{
    lane_u at = offset + row + first;
    pair words = gather_pair(t.texels, at);
    lane_i seam = second < first;
    words.b = second == first ? words.a : words.b;
    if (any_lane(seam)) words.b = seam ? gather_u(t.texels, offset + row + second) : words.b;
    *a = texel_bytes(t, words.a, is_srgb);
    *b = texel_bytes(t, words.b, is_srgb);
    if (!HAS(FLOAT_TEXTURE) || !any_lane(is_float)) return;
    quad qa = gather_quad((global const float *)t.texels, is_float ? offset + (row + first) * 4u : U(0));
    quad qb = gather_quad((global const float *)t.texels, is_float ? offset + (row + second) * 4u : U(0));
    a->rgb = v3_select(is_float, v3_make(qa.a, qa.b, qa.c), a->rgb);
    b->rgb = v3_select(is_float, v3_make(qb.a, qb.b, qb.c), b->rgb);
    a->a = is_float ? qa.d : a->a;
    b->a = is_float ? qb.d : b->a;
}

/* Wraps a coordinate into [0, 1]: repeat (0), clamp (1), mirrored repeat (2). */
EC_FN lane_f texture_fold(lane_f u, lane_u wrap)
{
    lane_f repeat = u - floor(u);
    lane_f half_period = u * 0.5f;
    lane_f m = (half_period - floor(half_period)) * 2.0f;
    lane_f mirror = m > 1.0f ? 2.0f - m : m;
    lane_f clamped = min(max(u, F(0.0f)), F(1.0f));
    return wrap == 0u ? repeat : (wrap == 1u ? clamped : mirror);
}

/* Finds the two texels around u along one axis, and the weight of the second. */
EC_FN void texture_axis(lane_f u, lane_i size, lane_u wrap, lane_i is_nearest, lane_u *first, lane_u *second,
                         lane_f *weight)
{
    lane_f x = fma(texture_fold(u, wrap), int_to_lane_f(size), is_nearest ? F(0.0f) : F(-0.5f));
    lane_f base = floor(x);
    lane_i i0 = to_lane_i(base), i1 = i0 + 1, last = size - 1;
    lane_i w0 = i0 < 0 ? last : min(i0, last), w1 = i1 > last ? I(0) : max(i1, I(0)); /* repeat: across the seam */
    lane_i c0 = min(max(i0, I(0)), last), c1 = min(max(i1, I(0)), last);
    *first = int_to_lane_u(wrap == 0u ? w0 : c0);
    *second = int_to_lane_u(is_nearest ? uint_to_lane_i(*first) : (wrap == 0u ? w1 : c1));
    *weight = is_nearest ? F(0.0f) : x - base;
}

/* Samples the texture of a table's entry at (u, v); white off the lanes m. */
EC_FN rgba texture_sample(textures t, lane_i m, quad entry, lane_f u, lane_f v, bool is_srgb)
{
    lane_u offset = as_lane_u(entry.a), width = as_lane_u(entry.b), height = as_lane_u(entry.c), flags = as_lane_u(entry.d);
    lane_i is_nearest = (flags & EC_TEXTURE_NEAREST) != 0u, is_float = (flags & EC_TEXTURE_FLOAT) != 0u;
    lane_u x0, x1, y0, y1;
    lane_f fx, fy;
    texture_axis(u, uint_to_lane_i(width), flags & 3u, is_nearest, &x0, &x1, &fx);
    texture_axis(v, uint_to_lane_i(height), (flags >> EC_TEXTURE_WRAP_T) & 3u, is_nearest, &y0, &y1, &fy);
    rgba a, b, c, d;
    texture_row(t, offset, y0 * width, x0, x1, is_float, is_srgb, &a, &b);
    texture_row(t, offset, y1 * width, x0, x1, is_float, is_srgb, &c, &d);
    lane_f gx = 1.0f - fx, gy = 1.0f - fy;
    lane_f wa = gx * gy, wb = fx * gy, wc = gx * fy, wd = fx * fy;
    rgba r;
    r.rgb = v3_fma(d.rgb, wd, v3_fma(c.rgb, wc, v3_fma(b.rgb, wb, v3_scale(a.rgb, wa))));
    r.a = fma(d.a, wd, fma(c.a, wc, fma(b.a, wb, a.a * wa)));
    r.rgb = v3_select(m, r.rgb, v3_splat(F(1.0f)));
    r.a = m ? r.a : F(1.0f);
    return r;
}

#endif
