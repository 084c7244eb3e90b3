/* Decides for --light-paths auto whether so much of the picture's noise is that of caustics that light paths pay.
 *
 * The first look at the picture's paths (rare/paths.h) predicts two things. For caustics that paths have met: how many light paths would pay
 * (rare/joined.h). For those that they hardly ever meet: their chance and light, and so the variance of a sample over the square of the mean
 * luminance that a pilot finds. All are the same whoever renders a part of a job, with however many devices, and no clock has a say. */
#include <float.h>
#include <math.h>

#include "pack/pack.h"
#include "render/render_state.h"

#define RARE_PAYS 4.0        /* variance of a sample over the square of the mean: 25 % of noise at 64 samples a pixel */
#define PILOT 8192u          /* samples */

bool ec_render_may_have_caustics(const ec_render_options *o, const ec_scene *scene)
{
    return o->light_paths == EC_LIGHT_PATHS_AUTO && ec_scene_casts(scene);
}

/* Returns the mean luminance that rare paths alone bring; the least number where that is nothing. */
static double least_mean(const ec_rare *rare)
{
    double sum = 0;
    for (uint32_t i = 0; i < rare->count; i++) sum += rare->kinds[i].is_relative ? 0 : rare->kinds[i].luminance;
    return fmax(sum, DBL_MIN);
}

static void note_common(const ec_joined_choice *joined, const ec_log *log)
{
    ec_note(log, "caustics: light paths are traced too, one for every %.0f from the camera, since they remove about %.0f %% of the variance (--light-paths 0: none)",
            1 / joined->number, 100 * joined->share);
}

static void note_rare(const ec_rare_kind *most, double variance, const ec_log *log)
{
    char way[EC_RARE_WAY];
    ec_rare_way(most->through, most->light, way, sizeof way);
    ec_note(log, "caustics: paths %s are so rare that their noise would be %.0f %% at 64 samples a pixel; light paths are traced too, one for every %.0f from the "
                 "camera, and guide directions (--light-paths 0: none)", way, 12.5 * sqrt(variance), 1 / EC_LIGHT_PATHS_RARE);
}

/* Judges whether caustics that paths have hardly ever met make light paths pay. */
static ec_result judge_rare(ec_render_state *r, bool *pays, const ec_log *log, ec_error *err)
{
    const ec_render_options *o = r->options;
    const uint32_t fits = o->width < PILOT ? PILOT / o->width : 1, rows = fits < o->height ? fits : o->height;
    const ec_rare_kind *most;
    double mean;
    *pays = false;
    if (ec_rare_caustics(&r->rare, least_mean(&r->rare), &most) < RARE_PAYS) return EC_OK;
    EC_TRY(r->source->turn_to(r->source, 0, rows, err));
    EC_TRY(ec_render_pilot_mean(r, PILOT, rows, &mean, err));
    if (!(mean > 0)) return EC_OK;
    const double variance = ec_rare_caustics(&r->rare, mean, &most);
    *pays = variance >= RARE_PAYS;
    if (*pays) note_rare(most, variance, log);
    return EC_OK;
}

ec_result ec_render_judge_caustics(ec_render_state *r, ec_caustics *caustics, const ec_log *log, ec_error *err)
{
    bool rare;
    EC_TRY(ec_render_predict(r, err));
    EC_TRY(judge_rare(r, &rare, log, err));
    *caustics = rare ? EC_CAUSTICS_RARE : r->joined.number > 0 ? EC_CAUSTICS_COMMON : EC_CAUSTICS_NONE;
    if (*caustics == EC_CAUSTICS_COMMON) note_common(&r->joined, log);
    return EC_OK;
}
