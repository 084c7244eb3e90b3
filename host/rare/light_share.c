/* Light of a kind that has share p of the light samples has variance V / p, about. V, what it has with all of them, is half the mean squared
 * difference of two paths of a pixel whose light samples all go to that kind. Densities stay those of halves, as weights against directions that
 * surfaces choose need them. Adaptive sampling gives a part of the picture samples in proportion to its standard error, and an error that comes of
 * few pixels says nothing of the others: so what is minimised is the sum over blocks of pixels of their standard errors. */
#include "rare/light_share.h"

#include <math.h>
#include <stdlib.h>

#include "device/light_share.h"
#include "rare/look.h"

#define PATHS (1u << 12)
#define BLOCK 8 /* pixels */
#define STEPS 16
#define LEAST 2 /* of STEPS, so that what few paths have missed is no firefly */

enum { FAR, LAMPS, KINDS };

typedef struct gathered {
    ec_look look;
    int kind;
    float *rgb, *luminance; /* of a wave's slots */
    float *light[KINDS]; /* of each path: the luminance of all that was sampled */
} gathered;

static ec_result add(gathered *g, float sign, ec_error *err)
{
    float *light = g->light[g->kind] + g->look.first;
    EC_TRY(ec_look_luminance(&g->look, g->rgb, g->luminance, err));
    for (uint32_t i = 0; i < g->look.count; i++) light[i] += sign * g->luminance[i];
    return EC_OK;
}

static ec_result before(void *user, uint32_t bounce, ec_error *err)
{
    (void)bounce;
    return add(user, -1, err);
}

static ec_result after(void *user, uint32_t bounce, ec_error *err)
{
    (void)bounce;
    return add(user, 1, err);
}

/* Traces paths whose light samples go to one kind, by all random numbers but one. */
static ec_result trace(gathered *g, int kind, ec_error *err)
{
    g->kind = kind;
    ec_light_numbers_set(&g->look.p->params, kind == FAR ? UINT32_MAX : 1);
    return ec_look_trace(&g->look, err);
}

static double squared_error(const float *light, uint32_t first, uint32_t end)
{
    double sum = 0;
    for (uint32_t i = first; i + 1 < end; i += 2) sum += pow((double)light[i] - light[i + 1], 2);
    return sum;
}

static double error_of(const gathered *g, double share)
{
    const uint32_t paths = g->look.paths;
    double sum = 0;
    for (uint32_t first = 0; first < paths; first += 2 * BLOCK) {
        const uint32_t end = first + 2 * BLOCK < paths ? first + 2 * BLOCK : paths;
        sum += sqrt(squared_error(g->light[FAR], first, end) / share + squared_error(g->light[LAMPS], first, end) / (1 - share));
    }
    return sum;
}

static double least_error(const gathered *g)
{
    double best = 0.5, least = error_of(g, best);
    for (int step = LEAST; step <= STEPS - LEAST; step++) {
        const double share = (double)step / STEPS, error = error_of(g, share);
        if (error < least) least = error, best = share;
    }
    return best;
}

static ec_result find_share(gathered *g, double *share, ec_error *err)
{
    const uint32_t most = g->look.paths < g->look.p->wave ? g->look.paths : g->look.p->wave;
    g->rgb = malloc(6ull * sizeof *g->rgb * most);
    g->luminance = malloc(sizeof *g->luminance * most);
    for (int k = 0; k < KINDS; k++) g->light[k] = calloc(g->look.paths, sizeof *g->light[k]);
    if (!g->rgb || !g->luminance || !g->light[FAR] || !g->light[LAMPS]) return ec_fail(err, "out of memory for %u paths", g->look.paths);
    EC_TRY(trace(g, FAR, err));
    EC_TRY(trace(g, LAMPS, err));
    *share = least_error(g);
    return EC_OK;
}

ec_result ec_light_share_choose(ec_pipeline *p, double *share, ec_error *err)
{
    const ec_params params = p->params;
    *share = 0;
    if (!params.far_numbers || p->integrator != EC_INTEGRATOR_PATH || !params.light_count) return EC_OK;
    gathered g = {.look = {.p = p, .paths = ec_look_paths(p, PATHS), .each = 1, .replicates = 2, .bounces = params.max_depth, .samples_light = true,
                           .shaded = before, .lit = after, .user = &g}};
    ec_result result = find_share(&g, share, err);
    free(g.rgb);
    free(g.luminance);
    for (int k = 0; k < KINDS; k++) free(g.light[k]);
    p->params = params;
    if (result != EC_OK) return result;
    ec_light_share_set(&p->params, *share);
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}
