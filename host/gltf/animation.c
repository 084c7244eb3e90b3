/* Makes many scenes, one for each moment, of one document. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf.h"
#include "gltf/reader.h"
#include "gltf/span.h"

struct ec_animation {
    ec_gltf *gltf;
    char *path;
    double posed_at; /* time in seconds at which the document is posed, if no scene has been made of it yet; otherwise NaN */
    bool spans;      /* low and high are known: a box that holds everything at all times */
    double low[3], high[3];
};

/* Allocates the table in which pictures, decoded when the first scene needs them, are kept for the others. */
static ec_result make_room(ec_gltf *g, ec_error *err)
{
    g->decoded_count = g->image_count;
    g->decoded = calloc((size_t)g->decoded_count + 1, sizeof *g->decoded);
    return g->decoded ? EC_OK : ec_fail(err, "%s: out of memory for %u images", g->path, g->image_count);
}

ec_result ec_animation_open(const char *path, const ec_scene_choice *choice, ec_animation **animation,
                            const ec_log *log, ec_error *err)
{
    ec_scene_choice moment;
    ec_animation *a = *animation = calloc(1, sizeof *a);
    if (!a || !(a->path = strdup(path))) {
        free(a);
        *animation = NULL;
        return ec_fail(err, "%s: out of memory", path);
    }
    ec_result result = ec_settle_moment(path, choice, &moment, err);
    moment.frame = true;
    if (result == EC_OK) result = ec_gltf_read(a->path, &moment, &a->gltf, log, err);
    if (result == EC_OK) result = make_room(a->gltf, err);
    if (result == EC_OK) {
        a->gltf->instancing = choice->instancing;
        a->posed_at = moment.at;
        return EC_OK;
    }
    ec_animation_close(a);
    *animation = NULL;
    return result;
}

ec_result ec_animation_show(ec_animation *a, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log, ec_error *err)
{
    ec_scene_choice moment;
    *scene = NULL;
    EC_TRY(ec_settle_moment(a->path, choice, &moment, err));
    if (a->posed_at != moment.at) EC_TRY(ec_gltf_pose(a->gltf, &moment, true, log, err));
    a->posed_at = NAN;
    EC_TRY(ec_scene_from_gltf(&moment, a->gltf, scene, log, err));
    a->gltf->image_light.used = false;
    (*scene)->spans = a->spans;
    memcpy((*scene)->span_min, a->low, sizeof a->low);
    memcpy((*scene)->span_max, a->high, sizeof a->high);
    return EC_OK;
}

/* Finds how long the chosen animations take, in seconds; 0: the file does not say. */
static ec_result find_seconds(const ec_animation *a, const ec_scene_choice *choice, double *seconds, ec_error *err)
{
    const ec_scene_contents *c = &a->gltf->contents;
    const bool all = choice->animation && !strcmp(choice->animation, "all");
    uint32_t one = 0;
    *seconds = 0;
    if (choice->animation && !all) EC_TRY(ec_scene_names_find(&c->animations, "animation", choice->animation, &one, err));
    for (uint32_t i = 0; i < c->animations.count; i++)
        if ((all || i == one) && isfinite(c->seconds[i])) *seconds = fmax(*seconds, c->seconds[i]);
    return EC_OK;
}

ec_result ec_animation_find_span(ec_animation *a, const ec_scene_choice *choice, ec_error *err)
{
    ec_scene_choice moment;
    double seconds;
    EC_TRY(ec_settle_moment(a->path, choice, &moment, err));
    if (!moment.animated) return EC_OK;
    EC_TRY(find_seconds(a, choice, &seconds, err));
    a->posed_at = NAN;
    EC_TRY(ec_gltf_span(a->gltf, &moment, seconds, a->low, a->high, err));
    a->spans = a->low[0] <= a->high[0];
    return EC_OK;
}

void ec_animation_digest(const ec_animation *a, char digest[65])
{
    for (int i = 0; i < 32; i++) snprintf(digest + 2 * i, 3, "%02x", a->gltf->digest[i]);
}

void ec_animation_close(ec_animation *a)
{
    if (!a) return;
    ec_gltf_free(a->gltf);
    free(a->path);
    free(a);
}
