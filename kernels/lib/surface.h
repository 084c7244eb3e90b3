/* Turns a hit into a shading point: position with its error bound, normals, material parameters. */
#ifndef EC_LIB_SURFACE_H
#define EC_LIB_SURFACE_H

#include "bodies.h"
#include "layers.h"

typedef struct surface {
    v3 p;          /* hit point, recentred frame */
    v3 p_error;    /* bound of its rounding, per axis */
    v3 ng;         /* geometric normal, unit, on the side of wo */
    v3 ns, s, t;   /* shading frame, ns on the side of ng */
    lane_i bent;   /* ns was turned, since wo would see its back */
    lane_i front;  /* wo is on the front */
    v3 base;       /* base colour, linear */
    lane_f metallic;
    lane_f alpha_ggx; /* roughness squared, at least EC_SMOOTH_ALPHA */
    lane_f stretch;   /* of the lobe along s: KHR_materials_anisotropy; 1 where there is none */
    lane_i smooth;    /* narrower than that: reflection and refraction have one direction each */
    v3 f0;         /* dielectric reflectance at normal incidence */
    lane_f f90;    /* and at grazing */
    lane_f transmission; /* share of what a dielectric does not reflect that passes; the base scatters the rest back */
    lane_f eta;    /* index of refraction beyond the surface over that on wo's side; 1: passes through a thin wall */
    lane_i refracts;     /* bounds a body: what passes goes on inside, refracted if transmission is above 0 */
    lane_u bodies, beyond; /* with NESTED: the bodies on wo's side, and those behind (bodies.h) */
    lane_i displaced;      /* the same body fills both sides */
    lane_f head_on;        /* head-on reflectance that f0 is multiplied by, where it depends on the media of both sides */
    lane_f diffuse_transmission;        /* KHR_materials_diffuse_transmission: share of diffuse light that comes out on the other side */
    v3 transmission_color;           /* and its colour */
    lane_f coat;       /* weight of a clear coat; then its width, as alpha_ggx and smooth, and its normal */
    lane_f coat_alpha;
    lane_i coat_smooth;
    v3 coat_ns;
    lane_f film;       /* weight of a thin film; then its index, and its thickness in nanometres */
    lane_f film_ior, film_thickness;
#define SURFACE_LAYER(feature, layer) layer##_look layer;
    LAYERS_UP(SURFACE_LAYER)
} surface;

/* Position, its error bound and the geometric normal; wo points away from the surface. */
EC_FN void surface_place(const hit_point *h, v3 wo, surface *s)
{
    v3 v0 = h->p0, v1 = h->p1, v2 = h->p2;
    s->p = v3_fma(v2, h->b2, v3_fma(v1, h->b1, v3_scale(v0, h->b0)));
    /* pbrt-v4 6.8.5: gamma_7 sum |b_i v_i|; two more for rounding the offset itself. */
    v3 sum = v3_fma(v3_abs(v2), h->b2, v3_fma(v3_abs(v1), h->b1, v3_scale(v3_abs(v0), h->b0)));
    s->p_error = v3_scale(sum, F(EC_GAMMA(9)));
    v3 n = v3_normalize(v3_cross(v3_sub(v1, v0), v3_sub(v2, v0)));
    s->front = v3_dot(n, wo) > 0.0f;
    s->ng = v3_select(s->front, n, v3_negate(n));
    s->bodies = s->beyond = U(0);
}

/* Returns the origin of a ray just off the surface on the side of `towards`: outside the error box around p (pbrt-v4, eq. 6.31). */
EC_FN v3 surface_offset(v3 p, v3 p_error, v3 n, v3 towards)
{
    lane_f d = v3_dot(v3_abs(n), p_error);
    d = v3_dot(n, towards) < 0.0f ? -d : d;
    return v3_fma(n, d, p);
}

/* Returns the 2 x 2 matrix of KHR_texture_transform, from the mesh's uv to the texture's: two rows, without the offset. */
EC_FN quad surface_turn(const geometry *g, const hit_point *h, uint slot)
{
    quad head = material_quad(g, h, EC_WORD_slots + slot * 8u), tail = material_quad(g, h, EC_WORD_slots + slot * 8u + 4u);
    quad turn = {head.c, head.d, tail.b, tail.c};
    return turn;
}

/* Returns the tangent d/du' of a texture whose transform A rotates or mirrors it: (A22 d/du - A21 d/dv) / det A. */
EC_FN v3 surface_turn_tangent(lane_i turned, quad turn, lane_f det, v3 dpdu, v3 dpdv, lane_f *handedness)
{
    lane_f sign = det < 0.0f ? F(-1.0f) : F(1.0f);
    v3 along = v3_fma(dpdv, -turn.c * sign, v3_scale(dpdu, turn.d * sign));
    *handedness = turned ? *handedness * sign : *handedness;
    return v3_select(turned, along, dpdu);
}

/* Returns the tangent, and sets the handedness, of a texture with transform `turn` on a surface of normal n: the vertices' own, else dp/du of the
 * triangle. Green of a normal map points up in it, towards smaller v: on a front face the uv triangle of an unmirrored map then runs clockwise. */
EC_FN v3 surface_tangent(const geometry *g, const hit_point *h, lane_i second, quad turn, v3 n, lane_f *handedness)
{
    v3 tangent = v3_zero(), down = v3_zero(); /* down: d/dv, needed for rotated textures alone */
    lane_f turn_det = turn.a * turn.d - turn.b * turn.c;
    lane_i turned = (turn_det != 0.0f) & ((turn.c != 0.0f) | (turn.d < 0.0f) | (turn_det < 0.0f));
    bool turns = any_lane(turned);
    *handedness = F(1.0f);
    if (g->tangents) {
        lane_f hand;
        tangent = interpolate_tangent(g, h, &hand);
        *handedness = hand < 0.0f ? F(-1.0f) : F(1.0f);
        if (turns) down = v3_scale(v3_cross(tangent, n), *handedness);
    }
    lane_i missing = v3_dot(tangent, tangent) == 0.0f;
    if (any_lane(missing)) {
        lane_f u0 = second ? h->uv0.c : h->uv0.a, v0 = second ? h->uv0.d : h->uv0.b;
        lane_f du1 = (second ? h->uv1.c : h->uv1.a) - u0, dv1 = (second ? h->uv1.d : h->uv1.b) - v0;
        lane_f du2 = (second ? h->uv2.c : h->uv2.a) - u0, dv2 = (second ? h->uv2.d : h->uv2.b) - v0;
        v3 e1 = v3_sub(h->p1, h->p0), e2 = v3_sub(h->p2, h->p0);
        lane_f det = du1 * dv2 - du2 * dv1, sign = det < 0.0f ? F(-1.0f) : F(1.0f);
        v3 dpdu = v3_scale(v3_sub(v3_scale(e1, dv2), v3_scale(e2, dv1)), sign);
        if (turns) down = v3_select(missing, v3_scale(v3_sub(v3_scale(e2, du1), v3_scale(e1, du2)), sign), down);
        *handedness = missing ? -sign : *handedness;
        tangent = v3_select(missing, v3_select(det != 0.0f, dpdu, v3_zero()), tangent);
    }
    return turns ? surface_turn_tangent(turned, turn, turn_det, tangent, down, handedness) : tangent;
}

/* Bends the normal n by the normal map in slot `map`, whose scale is the third of the material's four words at `words`. */
EC_FN v3 surface_mapped_normal(const geometry *g, const hit_point *h, lane_i m, v3 n, uint map, uint words)
{
    quad slot = material_quad(g, h, EC_WORD_slots + map * 8u);
    m = m & (uint_to_lane_i(as_lane_u(slot.a)) >= 0);
    if (!any_lane(m)) return n;
    lane_f scale = material_quad(g, h, words).c, handedness;
    v3 texel = material_texture(g, h, m, map, false).rgb;
    lane_f x = fma(texel.x, F(2.0f), F(-1.0f)) * scale, y = fma(texel.y, F(2.0f), F(-1.0f)) * scale;
    lane_f z = fma(texel.z, F(2.0f), F(-1.0f));
    v3 t = surface_tangent(g, h, as_lane_u(slot.b) != 0u, surface_turn(g, h, map), n, &handedness);
    t = v3_fma(n, -v3_dot(n, t), t); /* Gram-Schmidt */
    lane_f t2 = v3_dot(t, t);
    t = v3_scale(t, 1.0f / sqrt(t2));
    v3 b = v3_scale(v3_cross(n, t), handedness);
    v3 r = v3_fma(b, y, v3_fma(t, x, v3_scale(n, z)));
    lane_f r2 = v3_dot(r, r);
    m = m & (t2 > 0.0f) & (r2 > 0.0f); /* maps of zeros and triangles without uv area keep their normal */
    return v3_select(m, v3_scale(r, 1.0f / sqrt(r2)), n);
}

/* Returns the least cosine between a shading normal and a direction whose cosine to ng is to_ng: below it the normal is bent. */
EC_FN lane_f surface_least_cosine(lane_f to_ng) { return min(to_ng, F(0.01f)); }

/* Turns the normal n to wo's side, and bends it where wo would see its back. */
EC_FN v3 surface_seen_normal(const surface *s, v3 wo, v3 n, lane_i *is_bent)
{
    /* Files whose normals oppose their winding exist: the side is the geometric normal's. */
    n = v3_select(v3_dot(n, s->ng) < 0.0f, v3_negate(n), n);
    lane_f cosine = v3_dot(n, wo), least = surface_least_cosine(v3_dot(s->ng, wo));
    v3 bent = v3_normalize(v3_fma(wo, least - cosine, n));
    *is_bent = cosine < least;
    return v3_select(*is_bent, bent, n);
}

/* Sets the shading normals and the frame. */
EC_FN void surface_frame(const geometry *g, const hit_point *h, lane_i m, v3 wo, surface *s)
{
    s->ns = s->coat_ns = s->ng;
    s->bent = !TRUE_MASK;
    if (HAS(SMOOTH_NORMALS) || HAS(NORMAL_TEXTURE) || HAS(CLEARCOAT_NORMAL_TEXTURE)) {
        v3 n = v3_select(s->front, s->ng, v3_negate(s->ng));
        if (HAS(SMOOTH_NORMALS) && g->normals) {
            v3 smooth = interpolate_normal(g, h);
            lane_f length2 = v3_dot(smooth, smooth);
            n = v3_select(length2 > 0.0f, v3_scale(smooth, 1.0f / sqrt(length2)), n);
        }
        v3 coat = n;
        if (HAS(NORMAL_TEXTURE)) n = surface_mapped_normal(g, h, m, n, EC_SLOT_NORMAL, EC_WORD_metallic);
        s->ns = s->coat_ns = surface_seen_normal(s, wo, n, &s->bent);
        if (HAS(CLEARCOAT_NORMAL_TEXTURE)) coat = surface_mapped_normal(g, h, m, coat, EC_SLOT_CLEARCOAT_NORMAL, EC_WORD_coat);
        lane_i unused;
        if (HAS(CLEARCOAT) && HAS_BENDING) s->coat_ns = surface_seen_normal(s, wo, coat, &unused);
    }
    v3_frame(s->ns, &s->s, &s->t);
}

/* Updates the sets of bodies where a wall is crossed, on the lanes `nested`. To meet a wall from behind means that its body was entered, seen or not;
 * from the front, that it was not. *here, *there: materials on wo's side and behind. */
EC_FN void surface_cross(const geometry *g, quad index, lane_i nested, surface *s, lane_u *here, lane_u *there)
{
    lane_u own = as_lane_u(index.c), bodies = s->front ? s->bodies & ~own : s->bodies | own;
    s->bodies = nested ? bodies : s->bodies;
    s->beyond = nested ? bodies ^ own : s->beyond;
    *here = bodies_material(g, nested ? s->bodies : U(0));
    *there = bodies_material(g, nested ? s->beyond : U(0));
    s->displaced = s->displaced | (nested & (*here == *there));
}

/* Likewise, and sets eta from the media of both sides. f0 of such materials is a colour to be multiplied by head_on, the reflectance head-on. */
EC_FN void surface_between(const geometry *g, quad index, lane_i nested, surface *s)
{
    lane_u here, there;
    lane_i bends = nested & s->refracts;
    surface_cross(g, index, bends, s, &here, &there);
    s->eta = bends ? bodies_index(g, there) / bodies_index(g, here) : s->eta;
    lane_f eta = bends ? s->eta : index.a, r = (eta - 1.0f) / (eta + 1.0f);
    s->head_on = nested ? r * r : F(1.0f);
}

/* Makes displaced walls let all light pass in a single direction. */
EC_FN void surface_displace(surface *s)
{
    lane_i gone = s->displaced;
    s->base = v3_select(gone, v3_splat(F(1.0f)), s->base);
    s->f0 = v3_select(gone, v3_zero(), s->f0);
    s->f90 = gone ? F(0.0f) : s->f90;
    s->metallic = gone ? F(0.0f) : s->metallic;
    s->transmission = gone ? F(1.0f) : s->transmission;
    s->smooth = s->smooth | gone;
    s->coat = gone ? F(0.0f) : s->coat;
#define SURFACE_LOSES(feature, layer) layer##_hide(gone, &s->layer);
    LAYERS_UP(SURFACE_LOSES)
    s->diffuse_transmission = gone ? F(0.0f) : s->diffuse_transmission;
    s->film = gone ? F(0.0f) : s->film;
    s->eta = gone ? F(1.0f) : s->eta;
}

/* Returns the lanes on which refraction has a single direction: its lobe has a width of about alpha |eta - 1|, and float half vectors do not resolve
 * a narrower one. */
EC_FN lane_i surface_passes_singly(const surface *s)
{
    return s->refracts & (s->alpha_ggx * fabs(s->eta - 1.0f) < EC_SMOOTH_ALPHA);
}

/* Widens the narrow axis of a stretched lobe that refracts (lanes m) to what half vectors resolve, the same from either side. Where the wide axis is
 * narrower than that, too, it has a single direction. */
EC_FN void surface_widen(lane_i m, surface *s)
{
    lane_f along = s->alpha_ggx * s->stretch, least = EC_SMOOTH_ALPHA * max(s->eta, F(1.0f)) / fabs(s->eta - 1.0f);
    m = m & s->refracts & (s->stretch > 1.0f);
    lane_i single = m & !(least < along);
    if (HAS(SMOOTH)) s->smooth = (s->smooth & !m) | single;
    m = m & !single & (s->alpha_ggx < least);
    s->alpha_ggx = m ? least : s->alpha_ggx;
    s->stretch = m ? along / least : s->stretch;
}

/* KHR_materials_transmission, _ior and _volume. A body is entered through its front. The medium around it is air unless bodies are nested. */
EC_FN void surface_transmission(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    lane_u flags = as_lane_u(material_quad(g, h, EC_WORD_emission).d);
    quad index = material_quad(g, h, EC_WORD_ior);
    s->transmission = material_quad(g, h, EC_WORD_absorption).d;
    if (HAS(TRANSMISSION_TEXTURE)) s->transmission *= material_texture(g, h, m, EC_SLOT_TRANSMISSION, false).rgb.x;
    s->refracts = ((flags & EC_MATERIAL_REFRACTS) != 0u) & (s->transmission > 0.0f) & (s->metallic < 1.0f);
    s->eta = s->refracts ? (s->front ? index.a : 1.0f / index.a) : F(1.0f);
    if (HAS(NESTED)) surface_between(g, index, ((flags & EC_MATERIAL_NESTED) != 0u) & ((flags & EC_MATERIAL_REFRACTS) != 0u), s);
    if (HAS(SMOOTH)) s->smooth = surface_passes_singly(s);
}

/* KHR_materials_anisotropy: alpha along the direction is mix(alpha, 1, strength^2), across it stays. The frame's s goes along it; where
 * a mesh has no tangents, nor coordinates to make them of, the lobe stays round. */
EC_FN void surface_anisotropy(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    quad q = material_quad(g, h, EC_WORD_anisotropy);
    lane_f strength = q.a, x = q.b, y = q.c, handedness;
    lane_u second = U(0);
    quad turn = {F(1.0f), F(0.0f), F(0.0f), F(1.0f)};
    m = m & (strength > 0.0f);
    if (!any_lane(m)) return;
    if (HAS(ANISOTROPY_TEXTURE)) {
        v3 t = material_texture(g, h, m, EC_SLOT_ANISOTROPY, false).rgb;
        quad slot = material_quad(g, h, EC_WORD_slots + EC_SLOT_ANISOTROPY * 8u);
        lane_i textured = uint_to_lane_i(as_lane_u(slot.a)) >= 0;
        lane_f u = textured ? fma(t.x, F(2.0f), F(-1.0f)) : F(1.0f), v = textured ? fma(t.y, F(2.0f), F(-1.0f)) : F(0.0f);
        x = fma(q.b, u, -q.c * v);
        y = fma(q.c, u, q.b * v);
        strength *= t.z;
        second = textured ? as_lane_u(slot.b) : second;
        turn = surface_turn(g, h, EC_SLOT_ANISOTROPY);
    }
    v3 n = v3_select(s->front, s->ns, v3_negate(s->ns)), t = surface_tangent(g, h, second != 0u, turn, n, &handedness);
    t = v3_fma(n, -v3_dot(n, t), t);
    lane_f t2 = v3_dot(t, t);
    t = v3_scale(t, 1.0f / sqrt(t2));
    v3 along = v3_normalize(v3_fma(v3_scale(v3_cross(n, t), handedness), y, v3_scale(t, x)));
    m = m & (t2 > 0.0f) & v3_is_finite(along);
    lane_f stretch = fma(strength * strength, 1.0f - s->alpha_ggx, s->alpha_ggx) / s->alpha_ggx;
    m = m & (stretch > 1.0f);
    s->stretch = m ? stretch : F(1.0f);
    if (HAS(SMOOTH)) s->smooth = s->smooth & !m;
    if (HAS(TRANSMISSION)) surface_widen(m, s);
    s->s = v3_select(m, along, s->s);
    s->t = v3_select(m, v3_cross(s->ns, along), s->t);
}

EC_FN lane_f surface_coat_weight(const geometry *g, const hit_point *h, lane_i m)
{
    lane_f weight = material_quad(g, h, EC_WORD_coat).a;
    if (HAS(CLEARCOAT_TEXTURE)) weight *= material_texture(g, h, m, EC_SLOT_CLEARCOAT, false).rgb.x;
    return weight;
}

/* KHR_materials_clearcoat. The inside of a body that refracts has none, nor other layers. */
EC_FN void surface_coat(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    lane_f roughness = material_quad(g, h, EC_WORD_coat).b, weight = surface_coat_weight(g, h, m);
    if (HAS(CLEARCOAT_TEXTURE)) roughness *= material_texture(g, h, m, EC_SLOT_CLEARCOAT_ROUGHNESS, false).rgb.y;
    s->coat = (s->refracts & !s->front) ? F(0.0f) : weight;
    s->coat_alpha = max(roughness * roughness, F(EC_SMOOTH_ALPHA));
    s->coat_smooth = roughness * roughness < EC_SMOOTH_ALPHA;
}

/* KHR_materials_diffuse_transmission. */
EC_FN void surface_diffuse_transmission(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    quad q = material_quad(g, h, EC_WORD_transmission_color);
    lane_u flags = as_lane_u(material_quad(g, h, EC_WORD_emission).d);
    s->transmission_color = v3_make(q.a, q.b, q.c);
    s->diffuse_transmission = q.d;
    if (HAS(DIFFUSE_TRANSMISSION_TEXTURE)) {
        s->transmission_color = v3_mul(s->transmission_color, material_texture(g, h, m, EC_SLOT_DIFFUSE_TRANSMISSION_COLOR, true).rgb);
        s->diffuse_transmission *= material_texture(g, h, m, EC_SLOT_DIFFUSE_TRANSMISSION, false).a;
    }
    s->diffuse_transmission = s->metallic < 1.0f ? s->diffuse_transmission : F(0.0f);
    lane_i bends = s->refracts;
    s->refracts = s->refracts | (((flags & EC_MATERIAL_BOUNDS) != 0u) & (s->diffuse_transmission > 0.0f));
    if (HAS(NESTED)) {
        lane_u here, there;
        surface_cross(g, material_quad(g, h, EC_WORD_ior),
                      s->refracts & !bends & ((flags & EC_MATERIAL_NESTED) != 0u), s, &here, &there);
    }
}

/* KHR_materials_iridescence. */
EC_FN void surface_film(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    quad q = material_quad(g, h, EC_WORD_film);
    s->film = q.a;
    s->film_ior = q.b;
    s->film_thickness = q.d;
    if (HAS(IRIDESCENCE_TEXTURE)) {
        s->film *= material_texture(g, h, m, EC_SLOT_IRIDESCENCE, false).rgb.x;
        lane_f t = material_texture(g, h, m, EC_SLOT_IRIDESCENCE_THICKNESS, false).rgb.y; /* 1 without a texture */
        s->film_thickness = fma(t, q.d, (1.0f - t) * q.c);
    }
    s->film = ((s->film_thickness > 0.0f) & (s->film_ior > 1.0f)) ? s->film : F(0.0f);
}

/* Reads the parameters of the metallic-roughness model with KHR_materials_specular, and of the layers over it. */
EC_FN void surface_material(const geometry *g, const hit_point *h, lane_i m, surface *s)
{
    s->base = surface_base_color(g, h, m).rgb;
    s->metallic = F(0.0f);
    s->alpha_ggx = s->stretch = F(1.0f);
    s->f0 = v3_zero();
    s->f90 = F(0.0f);
    s->smooth = s->refracts = !TRUE_MASK;
    s->transmission = F(0.0f);
    s->eta = s->head_on = F(1.0f);
    s->displaced = !TRUE_MASK;
    s->coat = F(0.0f);
#define SURFACE_LACKS(feature, layer) layer##_hide(TRUE_MASK, &s->layer);
    LAYERS_UP(SURFACE_LACKS)
    s->film = s->diffuse_transmission = F(0.0f);
    s->transmission_color = v3_zero();
    if (!HAS(SPECULAR)) return;
    quad factors = material_quad(g, h, EC_WORD_metallic), specular = material_quad(g, h, EC_WORD_f0);
    lane_f roughness = factors.b;
    s->metallic = factors.a;
    if (HAS(METALLIC_ROUGHNESS_TEXTURE)) {
        rgba t = material_texture(g, h, m, EC_SLOT_METALLIC_ROUGHNESS, false);
        roughness *= t.rgb.y;
        s->metallic *= t.rgb.z;
    }
    s->alpha_ggx = roughness * roughness;
    if (HAS(TRANSMISSION)) surface_transmission(g, h, m, s);
    if (HAS(SMOOTH)) s->smooth = s->smooth | (s->alpha_ggx < EC_SMOOTH_ALPHA);
    s->alpha_ggx = max(s->alpha_ggx, F(EC_SMOOTH_ALPHA));
    if (HAS(ANISOTROPY)) surface_anisotropy(g, h, m, s);
    lane_f weight = specular.d;
    v3 color = v3_make(specular.a, specular.b, specular.c);
    if (HAS(SPECULAR_TEXTURE)) {
        weight *= material_texture(g, h, m, EC_SLOT_SPECULAR, false).a;
        color = v3_mul(color, material_texture(g, h, m, EC_SLOT_SPECULAR_COLOR, true).rgb);
    }
    if (HAS(NESTED)) color = v3_scale(color, s->head_on);
    /* KHR_materials_specular: f0 = min(color ((ior - 1) / (ior + 1))^2, 1) weight. */
    s->f0 = v3_scale(v3_make(min(color.x, F(1.0f)), min(color.y, F(1.0f)), min(color.z, F(1.0f))), weight);
    s->f90 = weight;
    if (HAS(DIFFUSE_TRANSMISSION)) surface_diffuse_transmission(g, h, m, s);
    if (HAS(CLEARCOAT)) surface_coat(g, h, m, s);
#define SURFACE_READS(feature, layer)              \
    if (HAS(feature)) {                            \
        s->layer = layer##_read(g, h, m);          \
        layer##_hide(s->refracts & !s->front, &s->layer); \
    }
    LAYERS_UP(SURFACE_READS)
    if (HAS(IRIDESCENCE)) surface_film(g, h, m, s);
    if (HAS(NESTED)) surface_displace(s);
}

EC_FN v3 surface_to_local(const surface *s, v3 w)
{
    return v3_make(v3_dot(w, s->s), v3_dot(w, s->t), v3_dot(w, s->ns));
}
EC_FN v3 surface_to_world(const surface *s, v3 w)
{
    return v3_fma(s->ns, w.z, v3_fma(s->t, w.y, v3_scale(s->s, w.x)));
}

#endif
