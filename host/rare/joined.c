/* A light path reaches a point that the camera sees from some direction with a density in proportion to the radiance there: radiance times cosine
 * over the flux of all light paths. A path from the camera goes there with the cosine over pi. So light paths, N for each camera path, find it
 * r = N A pi radiance / flux times as densely, A the area of the whole picture at the point, and leave 1 / (1 + r) of the variance. */
#include "rare/joined.h"

#include <math.h>
#include <stdlib.h>


#define PI 3.14159265358979323846
#define DIRECT_LEFT 0.25 /* share of direct light's variance that is left where samples are in order, about */

/* Time of a sample, over that of one without light paths: shading weighs one more way, and a light path takes as long as some camera paths. */
#define TIME_WITH 1.25
#define TIME_EACH 2.2
#define PAYS 1.1         /* gain in time to an error: less does not pay for the kernels that have to be built */

static const double numbers[EC_JOINED_NUMBERS] = {1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2};

ec_result ec_joined_open(ec_joined *j, double flux, uint32_t paths, ec_error *err)
{
    *j = (ec_joined){.flux = flux};
    if (!(flux > 0)) return EC_OK;
    j->rgb = malloc(6ull * sizeof *j->rgb * paths);
    j->luminance = malloc(sizeof *j->luminance * paths);
    j->paths = calloc(paths, sizeof *j->paths);
    return j->rgb && j->luminance && j->paths ? EC_OK : ec_fail(err, "out of memory for %u paths", paths);
}

void ec_joined_close(ec_joined *j)
{
    free(j->rgb);
    free(j->luminance);
    free(j->paths);
    *j = (ec_joined){0};
}

void ec_joined_first(ec_joined_path *path, const ec_params *params, const float p[3], float beta)
{
    double way2 = 0, depth = 0;
    for (int k = 0; k < 3; k++) {
        const double way = (double)p[k] - params->camera_origin[k];
        way2 += way * way;
        depth += way * params->camera_forward[k];
    }
    const double cosine = depth / sqrt(way2);
    path->area = (float)(params->orthographic ? params->film_area : params->film_area * way2 * cosine * cosine * cosine);
    path->beta = beta;
}

static void add(ec_joined *j, ec_joined_path *path, float light, bool is_joined)
{
    path->indirect += light;
    if (!is_joined || !(light > 0) || !(path->beta > 0)) return;
    for (int k = 0; k < EC_JOINED_NUMBERS; k++) {
        const double r = numbers[k] * path->area * PI * light / path->beta / j->flux;
        path->saved[k] += light * (float)sqrt(r / (1 + r));
    }
}

ec_result ec_joined_gather(ec_joined *j, const ec_look *look, uint32_t bounce, bool by_segment, ec_error *err)
{
    const bool is_direct = bounce + !by_segment < EC_DIRECT_SEGMENTS;
    if (!j->paths) return EC_OK;
    EC_TRY(ec_look_luminance(look, j->rgb, j->luminance, err));
    for (uint32_t i = 0; i < look->count; i++) {
        ec_joined_path *path = &j->paths[look->first + i];
        const float light = j->luminance[i] - path->radiance;
        path->radiance = j->luminance[i];
        if (!is_direct) add(j, path, light, by_segment ? path->by_segment : path->by_vertex);
    }
    return EC_OK;
}

/* Returns the gain in time to an error where `number` light paths a camera path take `saved` of the variance away. */
static double gain_of(double saved, double variance, double number)
{
    return 1 / ((1 - fmin(saved / variance, 0.99)) * (TIME_WITH + TIME_EACH * number));
}

ec_joined_choice ec_joined_choose(const ec_joined *j, uint32_t paths)
{
    ec_joined_choice best = {.number = 0};
    double saved[EC_JOINED_NUMBERS] = {0}, indirect = 0, all = 0, most = PAYS;
    for (uint32_t i = 0; j->paths && i < paths; i++)
        for (int k = 0; k < EC_JOINED_NUMBERS; k++) saved[k] += (double)j->paths[i].saved[k] * j->paths[i].saved[k];
    for (uint32_t i = 0; j->paths && i + 1 < paths; i += 2) {
        const ec_joined_path *a = &j->paths[i], *b = a + 1;
        indirect += pow((double)a->indirect - b->indirect, 2);
        all += pow((double)a->radiance - b->radiance, 2);
    }
    if (!(indirect > 0)) return best;
    const double noise = indirect + DIRECT_LEFT * fmax(all - indirect, 0);
    for (int k = 0; k < EC_JOINED_NUMBERS; k++) {
        const double gain = gain_of(saved[k], noise, numbers[k]);
        best.may |= gain_of(saved[k], indirect, numbers[k]) >= PAYS;
        if (gain < most) continue;
        most = gain;
        best.number = numbers[k];
        best.share = fmin(saved[k] / noise, 1);
    }
    return best;
}
