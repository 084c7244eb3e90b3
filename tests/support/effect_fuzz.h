/* Random scenes that mix all effects, to find scenes where the scan misses an effect: a specialised build and a full one must give the same
 * bits.
 *
 * A scene is a function of a seed and of the effects that it may need. An effect that it may not need may nearly be needed: with a factor
 * of 1 and a texture of zeros, in a material that nothing shows, or by a light without power. Two kinds of runs find two kinds of misses:
 *
 * shared: all scenes get the effects that they may need, in one build. Effects that are nearly needed must change nothing.
 * exact:  each scene gets what the scan found and no more. One material has all effects, so that none adds what another lacks. */
#ifndef EC_TESTS_SUPPORT_EFFECT_FUZZ_H
#define EC_TESTS_SUPPORT_EFFECT_FUZZ_H

#include <float.h>
#include <math.h>

#include "base/random.h"
#include "pack/pack.h"
#include "support/effect_model.h"
#include "support/render_case.h"

enum { EF_MATERIALS = 7 };
/* Effects that a scene cannot need by itself. */
#define EF_NEVER                                                                                                      \
    (EC_FEATURE_SOBOL | EC_FEATURE_TERMINATOR | EC_FEATURE_LENS | EC_FEATURE_PIXEL_FILTER | EC_FEATURE_LIGHT_TREE | EC_FEATURE_LAMP_PARTS | \
     EC_FEATURE_LAMP_PAIRS | EC_FEATURE_ENVIRONMENT_TURN | EC_FEATURE_MULTISCATTER | EC_FEATURE_FOG)

typedef enum effect_run { EF_SHARED, EF_EXACT } effect_run;

typedef struct effect_draw {
    uint64_t seed, allowed;
    effect_run run;
    uint32_t material; /* EF_MATERIALS: the whole scene */
} effect_draw;

/* A random number for a purpose, independent of all other draws, so that a scene can be reduced. */
static inline uint64_t ef_hash(const effect_draw *d, uint64_t purpose)
{
    return ec_random_mix(ec_random_mix(ec_random_mix(d->seed * EC_RANDOM_STEP + d->material) + purpose) + 1);
}
static inline float ef_real(const effect_draw *d, uint64_t purpose) { return (float)((double)(ef_hash(d, purpose ^ 0x5bd1u) >> 40) / (1 << 24)); }

/* A number between least and most, and in half of all cases one of these two. */
static inline float ef_between(const effect_draw *d, uint64_t purpose, float low, float least, float most, float high)
{
    const uint64_t end = ef_hash(d, purpose ^ 0xe4d5u) % 4;
    return end == 0 ? low : end == 1 ? high : least + (most - least) * ef_real(d, purpose);
}

/* ef_has: the material has the effect. ef_nearly: it has not, but nearly. */
static inline bool ef_has(const effect_draw *d, uint64_t feature)
{
    bool others = d->run == EF_EXACT && d->material < EF_MATERIALS && d->material != 1 + d->seed % (EF_MATERIALS - 1);
    return (d->allowed & feature) && !others && ef_hash(d, feature) % 4 != 0;
}
static inline bool ef_nearly(const effect_draw *d, uint64_t feature) { return !ef_has(d, feature) && ef_hash(d, feature) >> 32 & 1; }

/* Chooses a few effects, for scenes that need each of them for one reason only. */
static inline uint64_t ef_few(uint64_t seed)
{
    uint64_t set = 0;
    for (uint64_t i = 1; i <= 3; i++) set |= ec_features[ec_random_mix(seed * EC_RANDOM_STEP + i) % ec_feature_count].bit;
    return set;
}

/* Effects that these effects entail. */
static inline uint64_t ef_close(uint64_t set)
{
    static const uint64_t needs[][2] = {
        {EC_FEATURE_EMISSION_TEXTURE, EC_FEATURE_EMISSION},
        {EC_FEATURE_EMISSION, EC_FEATURE_AREA_LIGHTS},
        {EC_FEATURE_AREA_LIGHTS, EC_FEATURE_EMISSION},
        {EC_FEATURE_ENVIRONMENT_MAP, EC_FEATURE_ENVIRONMENT},
        {EC_FEATURE_SCATTERING, EC_FEATURE_ABSORPTION | EC_FEATURE_TRANSMISSION},
        {EC_FEATURE_TRANSMISSION_TEXTURE | EC_FEATURE_ABSORPTION | EC_FEATURE_DISPERSION, EC_FEATURE_TRANSMISSION},
        {EC_FEATURE_IRIDESCENCE_TEXTURE, EC_FEATURE_IRIDESCENCE},
        {EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE, EC_FEATURE_DIFFUSE_TRANSMISSION},
        {EC_FEATURE_CLEARCOAT_TEXTURE | EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE, EC_FEATURE_CLEARCOAT},
        {EC_FEATURE_SHEEN_TEXTURE, EC_FEATURE_SHEEN},
        {EC_FEATURE_ANISOTROPY_TEXTURE, EC_FEATURE_ANISOTROPY},
        {EC_FEATURE_FLOAT_TEXTURE, EC_FEATURE_BASE_COLOR_TEXTURE},
        {EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE | EC_FEATURE_SPECULAR_TEXTURE | EC_FEATURE_TRANSMISSION | EC_FEATURE_CLEARCOAT |
             EC_FEATURE_SHEEN | EC_FEATURE_ANISOTROPY | EC_FEATURE_SMOOTH | EC_FEATURE_IRIDESCENCE | EC_FEATURE_DIFFUSE_TRANSMISSION, EC_FEATURE_SPECULAR},
    };
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++)
        if (set & needs[i][0]) set |= needs[i][1];
    if (!(set & (EC_FEATURE_EMISSION | EC_FEATURE_ENVIRONMENT | EC_FEATURE_PUNCTUAL_LIGHTS))) set |= EC_FEATURE_ENVIRONMENT; /* light is needed */
    return set & ~EF_NEVER;
}

/* Effects that glass also needs, depending on its place and thickness, which no draw decides. */
static inline uint64_t ef_implied(uint64_t allowed, uint64_t called)
{
    if (!(allowed & EC_FEATURE_TRANSMISSION)) return 0;
    return EC_FEATURE_PANES | EC_FEATURE_MATCHED | EC_FEATURE_NESTED | (called & EC_FEATURE_NESTED ? EC_FEATURE_SMOOTH : 0);
}

#define EF_HAS(feature) ef_has(d, EC_FEATURE_##feature)
#define EF_NEARLY(feature) ef_nearly(d, EC_FEATURE_##feature)
#define EF_USE(slot, texture) em_use(m, EC_SLOT_##slot, EM_##texture)

static inline void ef_base(const effect_draw *d, ec_material *m)
{
    for (int k = 0; k < 3; k++) m->base_color[k] = 0.2f + 0.8f * ef_real(d, 100 + (uint64_t)k);
    m->double_sided = !EF_HAS(CULLING);
    m->unlit = EF_HAS(UNLIT) && d->material > 1;
    if (EF_HAS(FLOAT_TEXTURE) && EF_HAS(BASE_COLOR_TEXTURE)) EF_USE(BASE_COLOR, DEEP);
    else if (EF_HAS(BASE_COLOR_TEXTURE)) EF_USE(BASE_COLOR, NOISE);
    else if (EF_NEARLY(BASE_COLOR_TEXTURE)) EF_USE(BASE_COLOR, GREY);
    if (EF_HAS(ALPHA) || EF_NEARLY(ALPHA)) m->alpha_mode = ef_hash(d, 110) % 2 ? EC_ALPHA_MASK : EC_ALPHA_BLEND;
    if (EF_HAS(ALPHA)) m->base_color[3] = 0.4f + 0.5f * ef_real(d, 111);
    if (EF_NEARLY(ALPHA) && m->alpha_mode == EC_ALPHA_MASK) m->alpha_cutoff = 0.3f; /* texels of 100 / 255 and more */
    if (EF_NEARLY(ALPHA) && m->textures[EC_SLOT_BASE_COLOR].texture >= 0) m->alpha_mode = EC_ALPHA_MASK, m->alpha_cutoff = -1;
    if (EF_HAS(NORMAL_TEXTURE)) EF_USE(NORMAL, NOISE);
    else if (EF_NEARLY(NORMAL_TEXTURE)) EF_USE(NORMAL, NOISE), m->normal_scale = 0;
}

static inline void ef_light(const effect_draw *d, ec_material *m)
{
    const bool lamp = EF_HAS(EMISSION) || (d->material == 0 && (d->allowed & EC_FEATURE_EMISSION));
    if (!lamp && !EF_NEARLY(EMISSION)) return;
    for (int k = 0; k < 3; k++) m->emission[k] = 1 + ef_real(d, 120 + (uint64_t)k);
    if (!lamp) EF_USE(EMISSION, BLACK);
    else if (EF_HAS(EMISSION_TEXTURE)) EF_USE(EMISSION, MIXED);
    else if (EF_NEARLY(EMISSION_TEXTURE)) EF_USE(EMISSION, WHITE);
}

static inline void ef_gloss(const effect_draw *d, ec_material *m)
{
    m->roughness = EF_HAS(SMOOTH) ? 0 : ef_between(d, 130, 0.15f, 0.3f, 0.9f, 1); /* times a texel of 0.39, glass of index 1.14 is smooth from 0.1 on */
    if (!(d->allowed & EC_FEATURE_SPECULAR)) {
        if (EF_NEARLY(SPECULAR)) m->metallic = 1, EF_USE(METALLIC_ROUGHNESS, GREEN);
        if (EF_NEARLY(SPECULAR)) m->specular = 1, EF_USE(SPECULAR, BLACK);
        return;
    }
    if (EF_HAS(SPECULAR)) m->specular = ef_real(d, 131), m->metallic = ef_hash(d, 132) % 2 ? 0 : ef_real(d, 133);
    if (EF_HAS(METALLIC_ROUGHNESS_TEXTURE)) EF_USE(METALLIC_ROUGHNESS, NOISE);
    else if (EF_NEARLY(METALLIC_ROUGHNESS_TEXTURE)) EF_USE(METALLIC_ROUGHNESS, WHITE);
    if (EF_HAS(SPECULAR_TEXTURE)) EF_USE(SPECULAR, NOISE), EF_USE(SPECULAR_COLOR, NOISE);
    else if (EF_NEARLY(SPECULAR_TEXTURE)) EF_USE(SPECULAR_COLOR, GREY);
    for (int k = 0; k < 3; k++) m->specular_color[k] = ef_between(d, 135 + (uint64_t)k, 0, 0, 1, 1e4f);
    m->ior = ef_hash(d, 139) % 8 ? 1.2f + ef_real(d, 138) : 0;
    if (EF_HAS(SMOOTH) && ef_hash(d, 137) % 8 == 0) m->ior = ef_hash(d, 137) % 16 ? 1 : 1.000001f; /* refracts in a single direction */
}

static inline void ef_layers(const effect_draw *d, ec_material *m)
{
    const bool glass = EF_HAS(TRANSMISSION), coat = EF_HAS(CLEARCOAT), sheen = EF_HAS(SHEEN), brushed = EF_HAS(ANISOTROPY);
    if (glass || EF_NEARLY(TRANSMISSION)) {
        m->transmission = 0.3f + 0.7f * ef_real(d, 140);
        m->volume = ef_hash(d, 141) % 2;
        if (!glass) EF_USE(TRANSMISSION, BLACK);
        else if (EF_HAS(TRANSMISSION_TEXTURE)) EF_USE(TRANSMISSION, MIXED);
        else if (EF_NEARLY(TRANSMISSION_TEXTURE)) EF_USE(TRANSMISSION, GREY);
    }
    const bool takes_light_in = glass || EF_HAS(DIFFUSE_TRANSMISSION);
    if (EF_HAS(ABSORPTION) || (!takes_light_in && EF_NEARLY(ABSORPTION))) m->absorption[0] = 1, m->absorption[1] = ef_between(d, 142, 0, 0, 1, 1e30f);
    if (EF_HAS(SCATTERING)) m->scatter[1] = ef_between(d, 158, 1e-3f, 0.2f, 1, 1), m->scatter[2] = 0.5f, m->scatter_anisotropy = ef_between(d, 159, -0.999f, -0.5f, 0.9f, 0.999f);
    else if (EF_NEARLY(SCATTERING)) m->scatter[2] = 1; /* in the blue channel, in which nothing blocks light */
    if (coat || EF_NEARLY(CLEARCOAT)) {
        m->coat = 0.2f + 0.8f * ef_real(d, 143);
        m->coat_roughness = EF_HAS(SMOOTH) ? 0 : ef_between(d, 144, 0.05f, 0.2f, 1, 1);
        if (!coat) EF_USE(CLEARCOAT, GREEN);
        else if (EF_HAS(CLEARCOAT_TEXTURE)) EF_USE(CLEARCOAT, MIXED), EF_USE(CLEARCOAT_ROUGHNESS, NOISE);
        if (!coat || EF_HAS(CLEARCOAT_NORMAL_TEXTURE)) EF_USE(CLEARCOAT_NORMAL, NOISE);
    }
    if (sheen || EF_NEARLY(SHEEN)) {
        for (int k = 0; k < 3; k++) m->sheen[k] = k == 1 && !sheen ? 0 : ef_real(d, 145 + (uint64_t)k);
        m->sheen_roughness = ef_between(d, 148, 0, 0, 1, 1);
        if (!sheen) EF_USE(SHEEN_COLOR, GREEN), EF_USE(SHEEN_ROUGHNESS, NOISE);
        else if (EF_HAS(SHEEN_TEXTURE)) EF_USE(SHEEN_COLOR, MIXED), EF_USE(SHEEN_ROUGHNESS, NOISE);
    }
    if (EF_HAS(DISPERSION) || (!m->volume && EF_NEARLY(DISPERSION))) m->dispersion = ef_between(d, 151, 1e-3f, 0, 1, 20);
    if (EF_HAS(IRIDESCENCE) || EF_NEARLY(IRIDESCENCE)) {
        m->film = 0.5f + 0.5f * ef_real(d, 152);
        m->film_least = 0;
        m->film_most = EF_HAS(IRIDESCENCE) ? ef_between(d, 153, 1e-3f, 200, 500, 1e5f) : 0;
        if (EF_HAS(IRIDESCENCE) && EF_HAS(IRIDESCENCE_TEXTURE)) EF_USE(IRIDESCENCE_THICKNESS, NOISE);
    }
    if (EF_HAS(DIFFUSE_TRANSMISSION) || EF_NEARLY(DIFFUSE_TRANSMISSION)) {
        m->diffuse_transmission = 0.5f + 0.5f * ef_real(d, 154);
        for (int k = 0; k < 3; k++) m->transmission_color[k] = ef_real(d, 155 + (uint64_t)k);
        if (!EF_HAS(DIFFUSE_TRANSMISSION)) EF_USE(DIFFUSE_TRANSMISSION, BLACK);
        else if (EF_HAS(DIFFUSE_TRANSMISSION_TEXTURE)) EF_USE(DIFFUSE_TRANSMISSION, NOISE);
    }
    if (brushed || EF_NEARLY(ANISOTROPY)) {
        m->anisotropy = ef_between(d, 149, 0.01f, 0.2f, 1, 1);
        m->anisotropy_rotation = 6 * ef_real(d, 150);
        if (!brushed) EF_USE(ANISOTROPY, GREEN);
        else if (EF_HAS(ANISOTROPY_TEXTURE)) EF_USE(ANISOTROPY, NOISE);
    }
}

static inline ec_material ef_material(const effect_draw *d)
{
    ec_material m = em_plain();
    ef_base(d, &m);
    ef_light(d, &m);
    ef_gloss(d, &m);
    ef_layers(d, &m);
    return m;
}

/* A material with an effect that nothing shows: it needs no effects. */
static inline void ef_unused(effect_model *e)
{
    ec_material m = em_plain();
    for (int k = 0; k < EC_SLOT_COUNT; k++) em_use(&m, k, k % 2 ? EM_MIXED : EM_DEEP);
    m.double_sided = false;
    m.emission[0] = m.metallic = m.transmission = m.coat = m.sheen[0] = m.anisotropy = m.absorption[0] = 1;
    m.volume = true;
    m.alpha_mode = EC_ALPHA_BLEND;
    em_material(e, &m);
}

static inline void ef_lights(const effect_draw *d, effect_model *e)
{
    for (uint64_t i = 0; i < 3; i++) {
        const bool on = (d->allowed & EC_FEATURE_PUNCTUAL_LIGHTS) && (i == 0 || ef_hash(d, 160 + i) % 2);
        ec_light light = {.type = (ec_light_type)(ef_hash(d, 170 + i) % 3), .cos_inner = 0.9f, .cos_outer = 0.5f};
        for (int k = 0; k < 3; k++) light.intensity[k] = on ? 5 * ef_real(d, 180 + 4 * i + (uint64_t)k) : 0;
        ec_model_light(e->model, &light, (double[]){(double)i - 1, 3, 2}, (double[]){0, 0, 0});
    }
}

static inline void ef_environment(const effect_draw *d, ec_scene *s)
{
    ec_environment *env = &s->environment;
    const bool on = (d->allowed & EC_FEATURE_ENVIRONMENT), map = EF_HAS(ENVIRONMENT_MAP), flat = ef_hash(d, 190) % 2;
    s->has_environment = on || ef_hash(d, 191) % 2;
    for (int k = 0; k < 3; k++) env->constant[k] = on ? 0.2f + 0.5f * ef_real(d, 192 + (uint64_t)k) : 0;
    if (!map && !flat) return;
    env->width = 8, env->height = 4;
    env->rgb = calloc(96, sizeof *env->rgb);
    for (int i = 0; env->rgb && i < 96; i++) env->rgb[i] = env->constant[i % 3] * (map ? (float)(i / 3 * 13 % 7) : 1);
}

static inline void ef_colors(const effect_draw *d, ec_scene *s)
{
    const bool on = EF_HAS(VERTEX_COLORS);
    if (!on && !EF_NEARLY(VERTEX_COLORS)) return;
    s->colors = calloc(4 * (size_t)s->vertex_count, sizeof *s->colors);
    for (size_t i = 0; s->colors && i < 4 * (size_t)s->vertex_count; i++) s->colors[i] = on && i % 4 != 3 ? 0.5f + (float)(i % 5) / 8 : 1;
}

/* With motion, the first half of all triangles drifts, each vertex in its own way. Without it, lights have an index of keys but no motion
 * is declared. */
static inline void ef_motion(const effect_draw *d, ec_scene *s)
{
    ec_motion *m = &s->motion;
    const size_t n = s->vertex_count, keys = 3;
    if (!ef_has(d, EC_FEATURE_MOTION)) {
        for (uint32_t i = 0; i < s->light_count && ef_nearly(d, EC_FEATURE_MOTION); i++) s->lights[i].moves = 1;
        return;
    }
    *m = (ec_motion){.segments = 2, .vertex_count = s->vertex_count, .triangle_count = s->triangle_count / 2, .light_count = s->light_count};
    m->positions = malloc(n * keys * 3 * sizeof *m->positions);
    if (s->normals) m->normals = malloc(n * keys * 3 * sizeof *m->normals);
    m->swept = malloc(((size_t)m->triangle_count * 6 + 1) * sizeof *m->swept);
    m->lights = calloc(s->light_count * keys + 1, sizeof *m->lights);
    for (size_t i = 0; i < n * keys * 3; i++) {
        size_t vertex = i / (3 * keys), key = i / 3 % keys, from = 3 * vertex + i % 3;
        m->positions[i] = s->positions[from] + 0.1f * (float)key * (ef_real(d, 300 + from) - 0.5f);
        if (s->normals) m->normals[i] = s->normals[from];
    }
    for (uint32_t i = 0; i < s->light_count; i++) {
        for (size_t key = 0; key < keys; key++) {
            m->lights[i * keys + key] = s->lights[i];
            m->lights[i * keys + key].name = NULL;
            m->lights[i * keys + key].position[0] += 0.2f * (float)key;
        }
        s->lights[i].moves = i + 1;
    }
    for (size_t t = 0; t < m->triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            float *low = &m->swept[6 * t + k], *high = low + 3;
            *low = FLT_MAX, *high = -FLT_MAX;
            for (size_t i = 0; i < 3 * keys; i++) {
                float x = m->positions[(s->indices[3 * t + i / keys] * keys + i % keys) * 3 + k];
                *low = fminf(*low, x);
                *high = fmaxf(*high, x);
            }
            s->bounds_min[k] = fminf(s->bounds_min[k], *low);
            s->bounds_max[k] = fmaxf(s->bounds_max[k], *high);
        }
}

/* A floor, panes and balls before a camera. */
static inline ec_scene *ef_scene(uint64_t seed, effect_run run, uint64_t allowed)
{
    effect_draw draw = {seed, allowed, run, 0}, *d = &draw;
    effect_model e = em_new();
    int32_t material[EF_MATERIALS];
    ef_unused(&e);
    for (; d->material < EF_MATERIALS; d->material++) {
        ec_material m = ef_material(d);
        material[d->material] = em_material(&e, &m);
    }
    for (int i = 0; i < EF_MATERIALS; i++) {
        const double x = i % 3 - 1.0, y = i / 3 - 0.6, c = cos(i + 0.4), s = sin(i + 0.4);
        const double place[16] = {0.45 * c, 0, -0.45 * s, 0, 0, 0.45, 0, 0, 0.45 * s, 0, 0.45 * c, 0, x, y, 0.1 * i, 1};
        ec_model_place(e.model, place);
        if (i % 2) em_quad(&e, material[i], NULL);
        else ec_model_sphere(e.model, material[i], (double[]){0, 0, 0}, 0.9, 1, (allowed & EC_FEATURE_SMOOTH_NORMALS) && ef_hash(d, 200));
    }
    ec_model_place(e.model, NULL);
    ec_model_quad(e.model, material[1], (double[]){-4, -1, 3}, (double[]){8, 0, 0}, (double[]){0, 0, -6});
    ef_lights(d, &e);
    ec_model_camera(e.model, EC_CAMERA_PERSPECTIVE, (double[]){0.3, 0.6, 4}, (double[]){0, 0, 0}, 0.8);
    ec_scene *scene = em_scene(&e);
    ef_environment(d, scene);
    ef_colors(d, scene);
    ef_motion(d, scene);
    return scene;
}

/* Comparing builds -------------------------------------------------------------------------------------------------------------- */

static inline ec_render_options ef_options(ec_integrator integrator, ec_scattering scattering, ec_terminator terminator)
{
    ec_render_options o = case_options(16, 12, 4);
    o.max_depth = 5;
    o.lanes = 1; /* compiles quickest; another test shows that all widths give the same bits */
    o.accel = "bvh8";
    o.integrator = integrator;
    o.scattering = scattering;
    o.terminator = terminator;
    return o;
}

/* Compares the bits of both builds. `more`: effects by which scenes share kernels. */
static inline bool ef_same(const ec_scene *scene, ec_render_options o, uint64_t more, double *mean)
{
    o.more_effects = more;
    case_image special = case_render(scene, &o);
    o = case_with_all_effects(o);
    case_image full = case_render(scene, &o);
    bool same = case_same_bits(&special.film, &full.film);
    const uint64_t left_out = EC_FEATURE_ALL & ~(EC_FEATURES_FROM_LIGHTS | EC_FEATURE_LAYERS) & ~full.stats.effects.built; /* not effects */
    CHECK_MSG(!left_out, "the full build leaves out %llx", (unsigned long long)left_out);
    *mean = full.mean[0] + full.mean[1] + full.mean[2];
    case_free(&special);
    case_free(&full);
    return same;
}

/* Prints the smallest set of effects with which scene `seed` still fails, and the effects that repair it. */
static inline void ef_report(uint64_t seed, effect_run run, const ec_render_options *o, uint64_t allowed)
{
    char names[EC_EFFECT_NAMES], missed[EC_EFFECT_NAMES];
    double mean;
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        uint64_t less = ef_close(allowed & ~ec_features[i].bit);
        if (less == allowed || (less & allowed) != less) continue;
        ec_scene *scene = ef_scene(seed, run, less);
        if (!ef_same(scene, *o, run == EF_SHARED ? less : 0, &mean)) allowed = less;
        ec_scene_free(scene);
    }
    ec_scene *scene = ef_scene(seed, run, allowed);
    const uint64_t base = run == EF_SHARED ? allowed : 0;
    uint64_t mends = 0;
    for (uint32_t i = 0; i < ec_feature_count; i++)
        if (!((base | EF_NEVER) & ec_features[i].bit) && ef_same(scene, *o, base | ec_features[i].bit, &mean)) mends |= ec_features[i].bit;
    ec_scene_free(scene);
    ec_feature_names(allowed, names, sizeof names);
    ec_feature_names(mends, missed, sizeof missed);
    fprintf(stderr, "seed %llu, integrator %d, scattering %d, terminator %d: a specialised build gives other bits with no more than: %s; any of these built in mends it: %s\n",
            (unsigned long long)seed, (int)o->integrator, (int)o->scattering, (int)o->terminator, names, *missed ? missed : "none alone");
}

/* Tests `count` scenes with seeds from `first` on; returns how many of them are lit. With shared kernels, both effects that options control
 * are on, or neither; otherwise also one alone. The full build has both in any case. */
static inline int ef_run(uint64_t first, int count, effect_run run, ec_integrator integrator, ec_scattering scattering, uint64_t wanted)
{
    const uint64_t allowed = ef_close(integrator == EC_INTEGRATOR_PATH ? wanted : wanted & ~EC_FEATURE_MOTION); /* other integrators refuse motion */
    const uint64_t shared = allowed | EC_FEATURE_LIGHT_TREE | (allowed & EC_FEATURE_TRANSMISSION ? EC_FEATURE_PANES | EC_FEATURE_MATCHED | EC_FEATURE_NESTED : 0);
    int lit = 0;
    case_cl()->keeps_programs = true;
    for (uint64_t seed = first; seed < first + (uint64_t)count; seed++) {
        char names[EC_EFFECT_NAMES];
        double mean;
        ec_effects called;
        ec_error err = {0};
        const bool smooth = run == EF_SHARED ? scattering == EC_SCATTERING_MULTIPLE : seed / 2 % 2;
        const ec_render_options o = ef_options(integrator, scattering, smooth ? EC_TERMINATOR_SMOOTH : EC_TERMINATOR_GEOMETRIC);
        ec_scene *scene = ef_scene(seed, run, allowed);
        CHECK_OK(ec_scene_calls(scene, &called, &err), err);
        ec_feature_names(called.bits & ~(allowed | ef_implied(allowed, called.bits)), names, sizeof names);
        CHECK_MSG(!*names, "seed %llu: nothing has %s, and yet the scan calls for it", (unsigned long long)seed, names);
        bool same = ef_same(scene, o, run == EF_SHARED ? shared : 0, &mean);
        CHECK_MSG(same, "seed %llu: the specialised build gives other bits", (unsigned long long)seed);
        lit += mean > 0;
        ec_scene_free(scene);
        if (same) continue;
        ef_report(seed, run, &o, allowed);
        break; /* one failure is enough */
    }
    return lit;
}

#endif
