/* Direct light: chooses one light by its power, and one point or direction on it. Every emissive triangle is a light, and so are the punctual ones
 * and the environment. The number that chooses the light is reused for the point (choice.h). */
#ifndef EC_LIB_LIGHT_H
#define EC_LIB_LIGHT_H

#include "coat.h"
#include "environment.h"
#include "lamp_parts.h"
#include "light_share.h"
#include "light_tree.h"
#include "spherical_triangle.h"
#include "surface.h"

#define EC_LIGHTS_FEW 8u     /* tables of so many entries are searched in order */
#define EC_LIGHT_NEAR 0.25f /* squares of two edges over that of the distance to the centroid */

typedef struct light_sample {
    v3 wi;           /* unit, towards the light */
    v3 towards;      /* from p to the end of the shadow ray, unnormalised */
    v3 radiance;     /* arriving along wi if nothing is in the way; for punctual lights irradiance of a normal plane */
    lane_f pdf;      /* per solid angle, choice of the light included; punctual: the choice alone */
    lane_i is_delta; /* no other strategy can find it */
    lane_i is_far;   /* infinitely far: an environment, a directional light */
    lane_u target;   /* triangle the shadow ray ends on, or EC_NO_ID */
    v3 end_error;    /* error bound of the end point */
    v3 end_normal;   /* unit; zero where there is no surface */
    lane_i valid;
    lane_u id;       /* id: which light, with LIGHT_PATHS or LAYERS; per_area: 1 / area of a triangle, with LIGHT_PATHS */
    lane_f per_area;
} light_sample;

/* Returns by how much, along each axis, a traversal may misplace the point that a ray meets on a triangle. For each rounding of an edge function and
 * of its inputs it is u times `reach`, the mean of the vertices' distances from the ray's origin with the point's weights; along the ray, those of
 * the shear, of t and of the ray itself are added (ray.h). A face in the plane of a lamp is met no farther before the lamp than this. */
EC_FN v3 light_met_error(v3 reach, v3 towards)
{
    v3 way = v3_abs(towards);
    lane_i x = (way.x >= way.y) & (way.x >= way.z), y = !x & (way.y >= way.z);
    lane_f beyond = (x ? reach.x : y ? reach.y : reach.z) / v3_max_component(way);
    return v3_fma(way, beyond * EC_GAMMA(13), v3_scale(reach, F(EC_GAMMA(4))));
}

/* Returns the radiance that the triangle's point at these barycentrics sends along -wi, in the mean over rays that meet it or pass its coverage. */
EC_FN v3 light_radiance(const light_record *l, const geometry *g, lane_i m, lane_f b1, lane_f b2, v3 wi)
{
    v3 radiance = l->emission;
    if (!(HAS(EMISSION_TEXTURE) || HAS(CLEARCOAT) || HAS(ALPHA))) return radiance;
    lane_i textured = m & ((l->kind & EC_LIGHT_TEXTURED) != 0u), coated = m & ((l->kind & EC_LIGHT_COATED) != 0u);
    lane_i open = m & ((l->kind & EC_LIGHT_OPEN) != 0u), looks = textured | coated | open;
    if (!any_lane(looks)) return radiance;
    hit_point h = hit_point_make(g, looks ? l->prim : U(0), b1, b2);
    if (HAS(EMISSION_TEXTURE))
        radiance = v3_select(textured, v3_mul(radiance, material_texture(g, &h, textured, EC_SLOT_EMISSION, true).rgb),
                             radiance);
    if (HAS(ALPHA)) radiance = v3_scale(radiance, open ? surface_coverage(g, &h, open) : F(1.0f));
    return coat_emission(g, &h, coated, v3_negate(wi), radiance);
}

/* Makes the light sample of a triangle's point, given by its barycentrics, for p. Its pdf is that of uniform points; the caller sets its radiance. */
EC_FN light_sample light_point_of_triangle(const light_record *l, lane_i m, v3 p, lane_f b1, lane_f b2)
{
    light_sample s;
    v3 a = l->a, b = l->b, c = l->c;
    lane_f b0 = 1.0f - b1 - b2;
    v3 q = v3_fma(c, b2, v3_fma(b, b1, v3_scale(a, b0)));
    v3 sum = v3_fma(v3_abs(c), b2, v3_fma(v3_abs(b), b1, v3_scale(v3_abs(a), b0)));
    s.end_normal = v3_normalize(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    s.towards = v3_sub(q, p);
    v3 reach = v3_scale(v3_abs(v3_sub(a, p)), b0);
    reach = v3_fma(v3_abs(v3_sub(c, p)), b2, v3_fma(v3_abs(v3_sub(b, p)), b1, reach));
    s.end_error = v3_fma(sum, F(EC_GAMMA(9)), light_met_error(reach, s.towards));
    lane_f d2 = v3_dot(s.towards, s.towards);
    s.wi = v3_scale(s.towards, 1.0f / sqrt(d2));
    lane_f cosine = -v3_dot(s.wi, s.end_normal);
    cosine = (l->kind & EC_LIGHT_TWO_SIDED) != 0u ? fabs(cosine) : cosine;
    s.target = l->prim;
    s.pdf = l->pdf_a * d2 / cosine;
    s.is_delta = s.is_far = !TRUE_MASK;
    s.valid = m & (cosine > 0.0f) & (d2 > 0.0f);
    return s;
}

/* Returns whether a triangle is so near to p that it is sampled by solid angle. Sampling by area is cheaper, but its densities differ as the third
 * power of distances: with edges of half the distance that adds a relative standard deviation of 0.2, at most 0.5. */
EC_FN lane_i light_is_near(v3 v0, v3 v1, v3 v2, v3 p)
{
    v3 e1 = v3_sub(v1, v0), e2 = v3_sub(v2, v0);
    v3 sum = v3_fma(p, F(-3.0f), v3_add(v0, v3_add(v1, v2))); /* three times the way to the centroid */
    return v3_dot(e1, e1) + v3_dot(e2, e2) > (EC_LIGHT_NEAR / 9.0f) * v3_dot(sum, sum);
}

/* Returns the pdf of uniform directions to a triangle that is chosen with probability pmf; 0 where it has no solid angle. */
EC_FN lane_f light_near_pdf(const spherical_triangle *t, lane_f pmf)
{
    return t->turns > 0.0f ? pmf * (0.25f * EC_INV_PI) / t->turns : F(0.0f);
}

/* Returns the pdf at p of a point of a triangle, at squared distance d2 and seen under this cosine. Sampling and this decide between near and far by
 * the same numbers. */
EC_FN lane_f light_triangle_pdf(v3 v0, v3 v1, v3 v2, lane_f pdf_a, lane_i m, v3 p, lane_f d2, lane_f cosine)
{
    lane_f pdf = pdf_a * d2 / cosine;
    lane_i near = m & light_is_near(v0, v1, v2, p);
    if (any_lane(near)) {
        v3 a = v3_sub(v0, p), b = v3_sub(v1, p), c = v3_sub(v2, p);
        v3 n = v3_cross(v3_sub(v1, v0), v3_sub(v2, v0));
        lane_f pmf = pdf_a * 0.5f * sqrt(v3_dot(n, n));
        spherical_triangle t = spherical_triangle_make(a, b, c, fabs(v3_dot(a, n)));
        pdf = near ? light_near_pdf(&t, pmf) : pdf;
    }
    return pdf;
}

/* Returns the pdf for a lamp in parts: an eighth of `whole`, that of the lamp as a whole, plus that of the part in which the point lies. */
EC_FN lane_f light_parted_pdf(lane_f whole, const lamp_part *part, v3 v0, v3 v1, v3 v2, lane_f pdf_a, lane_i m, v3 p, lane_f d2, lane_f cosine)
{
    lamp_part_corners(part, &v0, &v1, &v2);
    lane_f own = light_triangle_pdf(v0, v1, v2, pdf_a * lamp_part_density(part), m, p, d2, cosine);
    return fma(whole, F(EC_LAMP_WHOLE), own);
}

/* Returns the pdf with which light_sample_lamp samples, for p, the point of triangle h that a path from p has met. */
EC_FN lane_f light_found_pdf(const geometry *g, const hit_point *h, lane_i m, v3 p, lane_f d2, lane_f cosine)
{
    lane_f pdf = light_triangle_pdf(h->p0, h->p1, h->p2, h->light_pdf_a, m, p, d2, cosine);
    lane_i parted = m & (h->parts != 0u);
    if (!HAS(LAMP_PARTS) || !g->parts || !any_lane(parted)) return pdf;
    lamp_part part = lamp_part_descend(g->parts, parted, h->parts, false, U(0), h->b1, h->b2);
    return parted ? light_parted_pdf(pdf, &part, h->p0, h->p1, h->p2, h->light_pdf_a, parted, p, d2, cosine) : pdf;
}

/* Sets the pdf of a sample of a lamp in parts, which may come from a part or from the whole. */
EC_FN void light_mix_parts(const light_record *l, const geometry *g, const lamp_part *part, lane_i m, v3 p, lane_f b1, lane_f b2, light_sample *s)
{
    lane_i parted = m & ((l->kind >> EC_LIGHT_PARTS) != 0u), whole = parted & (part->size == 1.0f);
    if (!g->parts || !any_lane(parted)) return;
    lamp_part own = *part;
    if (any_lane(whole)) {
        lamp_part found = lamp_part_descend(g->parts, whole, l->kind >> EC_LIGHT_PARTS, false, U(0), b1, b2);
        own.b1 = whole ? found.b1 : own.b1;
        own.b2 = whole ? found.b2 : own.b2;
        own.size = whole ? found.size : own.size;
        own.share = whole ? found.share : own.share;
    }
    lane_f d2 = v3_dot(s->towards, s->towards), cosine = fabs(v3_dot(s->wi, s->end_normal));
    lane_f all = light_triangle_pdf(l->a, l->b, l->c, l->pdf_a, parted, p, d2, cosine);
    s->pdf = parted ? light_parted_pdf(all, &own, l->a, l->b, l->c, l->pdf_a, parted, p, d2, cosine) : s->pdf;
    s->valid = s->valid & (!parted | (s->pdf > 0.0f));
}

/* Samples a point of a triangle or, with LAMP_PARTS, of its part, for p. */
EC_FN light_sample light_sample_triangle(const light_record *l, const geometry *g, const lamp_part *part, lane_i m, v3 p, lane_f u1, lane_f u2)
{
    lane_f root = sqrt(u1), b1 = u2 * root, b2 = root - b1, pdf = F(0.0f);
    v3 wi = v3_zero(), v0 = l->a, v1 = l->b, v2 = l->c;
    if (HAS(LAMP_PARTS)) lamp_part_corners(part, &v0, &v1, &v2);
    lane_i near = m & light_is_near(v0, v1, v2, p), seen = near;
    if (any_lane(near)) {
        v3 a = v3_sub(v0, p), b = v3_sub(v1, p), c = v3_sub(v2, p);
        v3 n = v3_cross(v3_sub(v1, v0), v3_sub(v2, v0));
        lane_f pmf = l->pdf_a * 0.5f * sqrt(v3_dot(n, n)), height = v3_dot(a, n);
        spherical_triangle t = spherical_triangle_make(a, b, c, fabs(height));
        lane_f near_b1, near_b2;
        pdf = light_near_pdf(&t, pmf);
        seen = (pdf > 0.0f) & ((height < 0.0f) | ((l->kind & EC_LIGHT_TWO_SIDED) != 0u));
        wi = spherical_triangle_sample(&t, v0, v1, v2, p, u1, u2, &near_b1, &near_b2);
        b1 = near ? near_b1 : b1;
        b2 = near ? near_b2 : b2;
    }
    if (HAS(LAMP_PARTS)) {
        b1 = fma(part->size, b1, part->b1);
        b2 = fma(part->size, b2, part->b2);
    }
    light_sample s = light_point_of_triangle(l, m, p, b1, b2);
    /* Keeps the sampled direction: right above the lamp the way to its point, which is rounded, leads anywhere. */
    s.wi = v3_select(near, wi, s.wi);
    s.radiance = light_radiance(l, g, m, b1, b2, s.wi);
    s.pdf = near ? pdf : s.pdf;
    s.valid = near ? seen : s.valid;
    if (HAS(LAMP_PARTS)) light_mix_parts(l, g, part, m, p, b1, b2, &s);
    return s;
}

/* Samples a point of a lamp for p, by one of its parts if it has some. */
EC_FN light_sample light_sample_lamp(const light_record *l, const geometry *g, lane_i m, v3 p, lane_f u1, lane_u r2)
{
    lamp_part part = lamp_part_all();
    lane_f u2 = to_unit(r2), left;
    lane_i parted = m & ((l->kind >> EC_LIGHT_PARTS) != 0u);
    if (HAS(LAMP_PARTS) && g->parts && any_lane(parted)) {
        part = lamp_part_choose(g->parts, parted, l->kind >> EC_LIGHT_PARTS, r2, &left);
        u2 = parted ? left : u2;
    }
    return light_sample_triangle(l, g, &part, m, p, u1, u2);
}

/* Returns what a spot sends along a direction over what it sends along its axis; 1 for point lights. cosine: between the two. */
EC_FN lane_f light_falloff(const light_record *l, lane_f cosine)
{
    lane_f cone = min(max((cosine - l->c.y) * l->c.x, F(0.0f)), F(1.0f));
    return (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_SPOT ? cone * cone : F(1.0f);
}

/* Returns the factor by which a light's range dims it at a squared distance: 1 near the light, 0 from the range on. */
EC_FN lane_f light_range_window(const light_record *l, lane_f d2)
{
    lane_f inverse_range = l->c.z;
    lane_f x2 = d2 * inverse_range * inverse_range;
    return min(max(1.0f - x2 * x2, F(0.0f)), F(1.0f));
}

/* KHR_lights_punctual: inverse square with a smooth range window, cone falloff squared. */
EC_FN light_sample light_sample_punctual(const light_record *l, lane_i m, v3 p, float scene_radius)
{
    light_sample s;
    v3 position = l->a, direction = l->b;
    lane_i is_directional = (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_DIRECTIONAL;
    v3 to_point = v3_sub(position, p);
    v3 far = v3_scale(direction, F(-2.0f * scene_radius)); /* leaves the scene from any point in it */
    s.towards = v3_select(is_directional, far, to_point);
    lane_f d2 = v3_dot(to_point, to_point);
    s.wi = v3_select(is_directional, v3_negate(direction), v3_scale(to_point, 1.0f / sqrt(d2)));
    lane_f falloff = light_range_window(l, d2) / d2 * light_falloff(l, -v3_dot(s.wi, direction));
    s.radiance = v3_scale(l->emission, is_directional ? F(1.0f) : falloff);
    s.pdf = l->pmf;
    s.is_delta = m;
    s.is_far = is_directional;
    s.target = U(EC_NO_ID);
    s.end_error = s.end_normal = v3_zero();
    s.valid = m & (is_directional | (d2 > 0.0f));
    return s;
}

EC_FN light_sample light_sample_environment(const lights *l, lane_i m, lane_u r1, lane_u r2, float scene_radius)
{
    light_sample s;
    s.wi = environment_sample(&l->env, r1, r2, &s.pdf, &s.radiance);
    s.towards = v3_scale(s.wi, F(2.0f * scene_radius));
    s.is_delta = !TRUE_MASK;
    s.is_far = TRUE_MASK;
    s.target = U(EC_NO_ID);
    s.end_error = s.end_normal = v3_zero();
    s.valid = m & (s.pdf > 0.0f); /* a map may be black where its sample falls */
    return s;
}

EC_FN light_sample light_sample_select(lane_i m, light_sample a, light_sample b)
{
    light_sample s;
    s.wi = v3_select(m, a.wi, b.wi);
    s.towards = v3_select(m, a.towards, b.towards);
    s.radiance = v3_select(m, a.radiance, b.radiance);
    s.pdf = m ? a.pdf : b.pdf;
    s.is_delta = m ? a.is_delta : b.is_delta;
    s.is_far = m ? a.is_far : b.is_far;
    s.target = m ? a.target : b.target;
    s.end_error = v3_select(m, a.end_error, b.end_error);
    s.end_normal = v3_select(m, a.end_normal, b.end_normal);
    s.valid = m ? a.valid : b.valid;
    return s;
}

/* Samples one light for a point p, and a point or direction on it. r1, r2: random 32-bit numbers. */
EC_FN light_sample light_sample_one(const lights *l, const geometry *g, lane_i m, v3 p, lane_u r1, lane_u r2)
{
    constant ec_params *params = l->env.params;
    uint count = params->light_choices;
    lane_u first = U(0), share = U(0), id = U(0);
    r1 = light_share_number(params, r1);
    if (count > EC_LIGHTS_FEW) id = distribution_pick(l->shares, U(0), count, r1, &first, &share);
    else id = distribution_pick_few(l->shares, count, r1, &first, &share);
    lane_u rest = r1 - first;
    lane_f u1 = choice_rest(rest, share, r1), chance = F(1.0f);
    if (lights_have_tree(l)) {
        lane_i m_lamp = m & (id + 1u == count);
        if (any_lane(m_lamp)) {
            lane_f pmf, left;
            lane_u lamp = light_tree_choose(l, m_lamp, p, rest >> 1, params->light_tree_numbers, r1, &pmf, &left);
            id = m_lamp ? lamp : id;
            chance = m_lamp ? pmf : chance;
            u1 = m_lamp ? left : u1;
        }
    }
    light_record one = light_load(l, id);
    one.pmf *= chance;
    one.pdf_a *= chance;
    if (HAS(LAMP_PAIRS) && !lights_have_tree(l)) light_choose_of_pair(l, m, p, &one, &id, &u1);
    one.pmf *= light_share_scale(params, one.kind);
    one.pdf_a *= light_share_of_lamp(params);
    if (HAS(MOTION) && g->motion) light_move(g, &one);
    lane_u type = one.kind & EC_LIGHT_KIND_MASK;

    light_sample s;
    s.valid = !TRUE_MASK;
    if (HAS(AREA_LIGHTS)) s = light_sample_lamp(&one, g, m & (type == EC_KIND_TRIANGLE), p, u1, r2);
    if (HAS(PUNCTUAL_LIGHTS)) {
        lane_i is = (type >= EC_KIND_POINT) & (type <= EC_KIND_DIRECTIONAL);
        light_sample other = light_sample_punctual(&one, m & is, p, params->scene_radius);
        s = HAS(AREA_LIGHTS) ? light_sample_select(is, other, s) : other;
    }
    if (HAS(ENVIRONMENT)) {
        lane_i is = type == EC_KIND_ENVIRONMENT;
        lane_u stretched = count > 1u ? choice_stretch(rest, U(params->environment_stretch[0]), U(params->environment_stretch[1]), r1) : r1; /* its share is the first */
        light_sample other = light_sample_environment(l, m & is, stretched, r2, params->scene_radius);
        s = HAS(AREA_LIGHTS) || HAS(PUNCTUAL_LIGHTS) ? light_sample_select(is, other, s) : other;
    }
    if (HAS(LIGHT_PATHS) || HAS(LAYERS)) s.id = id;
    if (HAS(LIGHT_PATHS)) s.per_area = motion_per_area(one.a, one.b, one.c);
    return s;
}

#endif
