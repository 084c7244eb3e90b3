#include "jobs/shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/channels.h"
#include "film/pixel.h"
#include "scene/ground.h"
#include "scene/material_fields.h"

/* Returns a black material with the coverage of m. Shadow rays pass through panes as they do through m, but not into bodies. */
static ec_material blackened(const ec_material *m)
{
    ec_material black = ec_material_default();
    const float passes = ec_refracts(m) || ec_bounds(m) ? 0 : fmaxf(m->transmission, m->diffuse_transmission);
    for (int k = 0; k < 3; k++) black.base_color[k] = 0;
    black.base_color[3] = m->base_color[3] * (1 - passes);
    black.metallic = black.specular = 0;
    black.alpha_mode = passes > 0 && m->alpha_mode == EC_ALPHA_OPAQUE ? EC_ALPHA_BLEND : m->alpha_mode;
    black.alpha_cutoff = m->alpha_cutoff;
    if (passes > 0 && m->alpha_mode == EC_ALPHA_OPAQUE) return black.double_sided = m->double_sided, black;
    black.textures[EC_SLOT_BASE_COLOR] = m->textures[EC_SLOT_BASE_COLOR];
    black.double_sided = m->double_sided;
    return black;
}

/* Makes a scene of only the ground: the last two triangles of a scene that consists of triangles. */
static ec_result leave_ground(const ec_scene *with, ec_scene *alone, ec_error *err)
{
    const size_t first = with->vertex_count - 4, triangle = with->triangle_count - 2;
    unsigned streams = 0;
    *alone = *with;
    for (int k = 0; k < EC_STREAMS; k++) streams |= (unsigned)(ec_scene_stream(with, k) != NULL) << k;
    alone->parts = NULL;
    alone->part_count = 0;
    alone->motion.vertex_count = alone->motion.triangle_count = 0;
    if (!ec_scene_allocate(alone, streams, 4, 2)) return ec_fail(err, "out of memory for a ground");
    for (int k = 0; k < EC_STREAMS; k++)
        if (streams >> k & 1) memcpy(ec_scene_stream(alone, k), ec_scene_stream(with, k) + first * ec_stream_width[k], 4 * ec_stream_width[k] * sizeof(float));
    for (int i = 0; i < 6; i++) alone->indices[i] = with->indices[3 * triangle + (size_t)i] - (uint32_t)first;
    memcpy(alone->triangle_material, with->triangle_material + triangle, 2 * sizeof *alone->triangle_material);
    alone->vertex_count = 4;
    alone->triangle_count = 2;
    return EC_OK;
}

ec_result ec_shadow_check(const ec_scene *scene, ec_error *err)
{
    if (!scene->triangle_count) return ec_fail(err, "--ground: the scene has no surface to stand on one; leave it out");
    if (scene->has_environment || scene->light_count) return EC_OK;
    return ec_fail(err, "--ground=shadow: neither an environment nor a lamp lights the ground, and surfaces that glow cast no shadows on it; give a --light");
}

typedef struct shadow_scenes {
    ec_scene with, without; /* each owns its geometry, and `with` also the materials of both */
} shadow_scenes;

static void free_scenes(shadow_scenes *s)
{
    ec_scene *with = &s->with;
    for (uint32_t m = 0; with->materials && m < with->material_count; m++) free(with->materials[m].name);
    free(with->materials);
    ec_scene_free_geometry(with);
    ec_scene_free_geometry(&s->without);
}

/* Makes the ground under the scene, whose surfaces are black but cover and transmit as before, and the ground alone. Emissive surfaces are black too,
 * as their light would have to fall on both. Everything else is shared with the scene. */
static ec_result prepare(const ec_scene *scene, shadow_scenes *made, ec_error *err)
{
    ec_scene *with = &made->with;
    EC_TRY(ec_scene_write_out(scene, with, err));
    with->parts = NULL;
    with->part_count = 0;
    with->materials = malloc((scene->material_count + 1) * sizeof *with->materials);
    if (!with->materials) return ec_fail(err, "out of memory for a ground");
    for (uint32_t m = 0; m < scene->material_count; m++) with->materials[m] = blackened(&scene->materials[m]);
    EC_TRY(ec_scene_add_ground(with, err));
    return leave_ground(with, &made->without, err);
}

/* Returns the ratio of a pixel's light with and without the scene; *se2: its squared standard error, linearised in the replicates' means (Cochran
 * 1977, 2.11). */
static double ratio_of(const double *with, const double *without, uint32_t n, double *se2)
{
    double a = 0, b = 0, sum = 0;
    for (uint32_t r = 0; r < n; r++) a += with[r], b += without[r];
    const double ratio = b > 0 ? a / b : NAN;
    for (uint32_t r = 0; r < n; r++) sum += pow(with[r] - ratio * without[r], 2);
    *se2 = n > 1 && b > 0 ? n / (n - 1.0) * sum / (b * b) : 0;
    return ratio;
}

static void lay(const ec_film films[2], ec_film *film, double *error)
{
    const uint32_t n = ec_film_replicates(&films[0]);
    double light[2][EC_REPLICATES_MOST], sum = 0, rgb[3];
    uint64_t seen = 0;
    for (uint64_t p = 0; p < (uint64_t)film->width * film->height; p++) {
        double se2;
        for (uint32_t f = 0; f < 2; f++)
            for (uint32_t r = 0; r < n; r++) {
                ec_film_replicate(&films[f], p, 1, r, rgb);
                light[f][r] = ec_luminance(rgb);
            }
        const double ratio = ratio_of(light[0], light[1], n, &se2);
        if (!(ratio >= 0)) continue; /* no ground in this pixel */
        film->shadow[p] = (float)fmin(fmax(1 - ratio, 0), 1);
        sum += se2;
        seen++;
    }
    *error = seen ? sqrt(sum / (double)seen) : NAN;
}

ec_result ec_shadow_cast(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t spp, ec_progress_fn go_on, void *user, ec_film *film,
                         double *error, const ec_log *log, ec_error *err)
{
    ec_film films[2] = {{0}, {0}};
    ec_render_options o = *options;
    shadow_scenes scenes = {.with = {0}};
    *error = NAN;
    if (!(ec_film_feature_samples(film) > 0)) return ec_fail(err, "--ground=shadow: the picture ended before its first hits were known");
    o.spp = spp;
    o.time_limit = o.error_target = o.clamp = o.light_paths = o.survival = 0;
    o.max_depth = 2; /* direct light only: a ground by itself receives no other */
    o.denoise = EC_DENOISER_NONE;
    o.layers = (ec_layers){.count = 0};
    o.adaptive = o.guiding = false;
    o.without = 0;
    o.followed = NULL;
    ec_result result = prepare(scene, &scenes, err);
    for (int i = 0; i < 2 && result == EC_OK; i++) {
        ec_render_stats stats = {0};
        result = ec_render(cl, i ? &scenes.without : &scenes.with, &o, go_on, user, &films[i], &stats, log, err);
        if (result == EC_OK && stats.samples_per_pixel < spp) result = ec_fail(err, "--ground=shadow: stopped before the shadows were there");
    }
    if (result == EC_OK && !film->shadow) film->shadow = calloc((uint64_t)film->width * film->height, sizeof *film->shadow);
    if (result == EC_OK && !film->shadow) result = ec_fail(err, "out of memory for a shadow");
    if (result == EC_OK) lay(films, film, error);
    ec_film_destroy(&films[0]);
    ec_film_destroy(&films[1]);
    free_scenes(&scenes);
    return result;
}
