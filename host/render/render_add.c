/* Adds batches to the film, and keeps what is in it and what there is of the batch under way. */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "device/adaptive.h"
#include "film/layer_films.h"
#include "film/threads.h"
#include "render/render_state.h"

uint64_t ec_render_order_samples(const ec_render_state *r)
{
    const uint32_t batches = r->source->batches > 1 ? r->source->batches : 1;
    if (r->order.light == EC_LIGHT_ALONE) return 0;
    if (r->order.list) return r->order.samples;
    return ec_schedule_samples(r->replicates, r->order.index + batches) - ec_schedule_samples(r->replicates, r->order.index) - r->order.cut;
}

uint32_t ec_render_wants_sets(const ec_render_state *r)
{
    const bool are_all = r->film->feature_end == UINT32_MAX;
    return are_all || (r->past.next < r->film->feature_end && !r->past.allotment.weight) ? r->film->feature_sets : 0;
}

void ec_render_keep(ec_render_state *r, uint32_t under_way)
{
    if (r->order.count > ec_render_film_pixels(r) || r->film->layers.count || r->film->light) under_way = 0;
    const bool is_new = r->past.next != r->kept_next || under_way > r->kept_under_way;
    if (!r->course->keep || !is_new || !(r->film->batch_count || under_way) || r->film->unsampled || r->film->cut) return;
    ec_past now = r->past;
    now.slope = r->goal.slope;
    now.seconds = ec_now() - r->render_start;
    if (under_way) {
        now.under_way = under_way;
        now.batch = r->source->mean;
        now.features = r->order.feature_sets ? r->source->features : NULL;
        now.rays = r->rays_before + r->source->rays;
        for (int i = 0; i < EC_STAGE_COUNT; i++) now.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    }
    if (r->course->keep(r->course->user, r->film, &now)) r->kept_next = now.next, r->kept_under_way = under_way;
    r->kept_at = ec_now();
}

/* Finds and clears pixels that the batch has not reached; returns how many. */
static uint64_t clear_unreached(float *mean, float *features, float *layers, uint32_t layer_count, uint64_t pixels, uint8_t *unsampled)
{
    uint64_t missing = 0;
#pragma omp parallel for reduction(+ : missing) if (ec_film_is_many(pixels))
    for (uint64_t i = 0; i < pixels; i++) {
        unsampled[i] = mean[EC_BATCH_FIELDS * i] == EC_NOT_REACHED;
        if (!unsampled[i]) continue;
        missing++;
        memset(mean + EC_BATCH_FIELDS * i, 0, EC_BATCH_FIELDS * sizeof *mean);
        memset(features + EC_AOV_FIELDS * i, 0, EC_AOV_FIELDS * sizeof *features);
        if (layers) memset(layers + 3 * layer_count * i, 0, EC_LAYER_BYTES * layer_count);
    }
    return missing;
}

static ec_result add_matte(ec_render_state *r, ec_error *err)
{
    if (!r->film->layers.mattes) return EC_OK;
    return ec_matte_take(&r->film->matte, &r->matte, r->order.list ? r->past.allotment.places : NULL, err);
}

/* Adds a first batch that was given up: it is the picture, since there is no other. */
static ec_result add_begun(ec_render_state *r, ec_error *err)
{
    const uint64_t pixels = (uint64_t)r->film->width * r->film->height, reached = r->source->reached;
    uint8_t *unsampled = r->film->unsampled = malloc(pixels);
    if (!unsampled) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    memset(unsampled + reached, 1, pixels - reached);
    const uint64_t missing = clear_unreached(r->source->mean, r->source->features, r->layers, r->film->layers.count, reached, unsampled);
    r->under_way = (reached - missing) * ec_render_order_samples(r);
    for (uint32_t k = 0; k < r->film->layers.count; k++) {
        ec_film_layer_batch(r->film, k, r->layers, reached, r->layer);
        EC_TRY(ec_film_take(&r->film->layer_films[k], &(ec_film_batch){.values = r->layer, .missing = pixels - reached}, err));
    }
    EC_TRY(add_matte(r, err));
    return ec_film_take(r->film, &(ec_film_batch){.values = r->source->mean, .features = r->source->features, .missing = pixels - reached}, err);
}

static ec_result add_block(ec_render_state *r, ec_error *err)
{
    ec_film_part part = {.first = r->past.next, .count = r->source->batches, .sums = r->source->sums};
    EC_TRY(ec_film_insert(r->film, &part, err));
    r->source->sums = (ec_sums){0};
    return EC_OK;
}

/* Adds the batch to the picture's film, or to a layer's. */
static ec_result add_to(const ec_render_state *r, ec_film *film, const float *mean, const float *features, ec_error *err)
{
    if (r->order.list) return ec_film_add_some(film, mean, features, r->past.allotment.places, r->order.count, r->order.samples, err);
    return ec_film_take(film, &(ec_film_batch){.index = r->past.next, .cut = r->order.cut, .values = mean, .features = features}, err);
}

static ec_result add_layers(ec_render_state *r, ec_error *err)
{
    for (uint32_t k = 0; k < r->film->layers.count; k++) {
        ec_film_layer_batch(r->film, k, r->layers, r->order.count, r->layer);
        EC_TRY(add_to(r, &r->film->layer_films[k], r->layer, NULL, err));
    }
    return EC_OK;
}

/* Adds a whole batch, or a block. */
static ec_result add_whole(ec_render_state *r, ec_error *err)
{
    if (r->order.cut) ec_render_keep(r, 0);
    EC_TRY(add_layers(r, err));
    EC_TRY(add_matte(r, err));
    if (r->source->batches > 1) return add_block(r, err);
    EC_TRY(add_to(r, r->film, r->source->mean, r->order.feature_sets ? r->source->features : NULL, err));
    const bool are_last = r->order.feature_sets && r->past.next + 1 == r->film->feature_end;
    return are_last && r->source->end_features ? r->source->end_features(r->source, err) : EC_OK;
}

/* Takes over what the source has counted so far, after the film has changed. */
static void take_counts(ec_render_state *r)
{
    for (int i = 0; i < EC_STAGE_COUNT; i++) r->past.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    r->past.rays = r->rays_before + r->source->rays;
    r->is_looked_at = false;
}

ec_result ec_render_add_light(ec_render_state *r, ec_error *err)
{
    EC_TRY(ec_film_add(r->film->light, r->order.index, r->source->mean, err));
    take_counts(r);
    return EC_OK;
}

ec_result ec_render_add_batch(ec_render_state *r, bool complete, ec_error *err)
{
    EC_TRY(complete ? add_whole(r, err) : add_begun(r, err));
    take_counts(r); /* what add_whole keeps at a job's end does not have the batch's */
    r->past.samples += r->under_way;
    r->past.next += r->source->batches;
    return EC_OK;
}
