/* A batch goes into the film; and what is in it, and of the batch that is under way, is kept. */
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

bool ec_render_wants_features(const ec_render_state *r)
{
    return r->past.next < r->feature_batches && r->film->aov_batches == r->past.next && !r->past.allotment.weight;
}

void ec_render_keep(ec_render_state *r, uint32_t under_way)
{
    if (ec_render_wants_features(r) || r->order.count > ec_render_film_pixels(r) || r->film->layers.count || r->film->light) under_way = 0;
    const bool is_new = r->past.next != r->kept_next || under_way > r->kept_under_way;
    if (!r->course->keep || !is_new || !(r->film->batch_count || under_way) || r->film->unsampled || r->film->cut) return;
    ec_past now = r->past;
    now.slope = r->goal.slope;
    now.seconds = ec_now() - r->render_start;
    if (under_way) {
        now.under_way = under_way;
        now.batch = r->source->mean;
        now.rays = r->rays_before + r->source->rays;
        for (int i = 0; i < EC_STAGE_COUNT; i++) now.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    }
    if (r->course->keep(r->course->user, r->film, &now)) r->kept_next = now.next, r->kept_under_way = under_way;
    r->kept_at = ec_now();
}

static float *batch_features(const ec_render_state *r) { return r->aov ? r->aov : r->source->features; }

/* Tells pixels that the batch has not reached, which then hold nothing; returns how many. */
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

/* A first batch that was given up is the picture, since there is no other. */
static ec_result add_begun(ec_render_state *r, ec_error *err)
{
    const uint64_t pixels = (uint64_t)r->film->width * r->film->height, reached = r->source->reached;
    uint8_t *unsampled = r->film->unsampled = malloc(pixels);
    if (!unsampled) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    memset(unsampled + reached, 1, pixels - reached);
    const uint64_t missing = clear_unreached(r->source->mean, batch_features(r), r->layers, r->film->layers.count, reached, unsampled);
    r->under_way = (reached - missing) * ec_render_order_samples(r);
    EC_TRY(ec_film_add_features(r->film, batch_features(r), reached, 0, r->options->denoise, err));
    for (uint32_t k = 0; k < r->film->layers.count; k++) {
        ec_film_layer_batch(r->film, k, r->layers, reached, r->layer);
        EC_TRY(ec_film_add_begun(&r->film->layer_films[k], r->layer, reached, err));
    }
    EC_TRY(add_matte(r, err));
    return ec_film_add_begun(r->film, r->source->mean, reached, err);
}

/* The last ones make room for the batch, before that goes into the film. */
static ec_result add_features(ec_render_state *r, ec_error *err)
{
    EC_TRY(ec_film_add_features(r->film, batch_features(r), r->order.count, r->order.cut, r->options->denoise, err));
    return r->source->end_features && r->past.next + 1 == r->feature_batches ? r->source->end_features(r->source, err) : EC_OK;
}

static ec_result add_block(ec_render_state *r, ec_error *err)
{
    ec_film_part part = {.first = r->past.next, .count = r->source->batches, .sums = r->source->sums};
    EC_TRY(ec_film_insert(r->film, &part, err));
    r->source->sums = (ec_sums){0};
    return EC_OK;
}

/* The picture's, or a layer's. */
static ec_result add_to(const ec_render_state *r, ec_film *film, const float *mean, ec_error *err)
{
    if (r->order.list) return ec_film_add_some(film, mean, r->past.allotment.places, r->order.count, r->order.samples, err);
    if (r->order.cut) return ec_film_add_cut(film, r->past.next, r->order.cut, mean, err);
    return ec_film_add(film, r->past.next, mean, err);
}

static ec_result add_layers(ec_render_state *r, ec_error *err)
{
    for (uint32_t k = 0; k < r->film->layers.count; k++) {
        ec_film_layer_batch(r->film, k, r->layers, r->order.count, r->layer);
        EC_TRY(add_to(r, &r->film->layer_films[k], r->layer, err));
    }
    return EC_OK;
}

/* Or the block. */
static ec_result add_whole(ec_render_state *r, ec_error *err)
{
    if (r->order.cut) ec_render_keep(r, 0);
    if (r->order.with_features) EC_TRY(add_features(r, err));
    EC_TRY(add_layers(r, err));
    EC_TRY(add_matte(r, err));
    return r->source->batches > 1 ? add_block(r, err) : add_to(r, r->film, r->source->mean, err);
}

/* What the source has counted so far; the film has changed. */
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
    take_counts(r); /* what add_whole keeps of a job's end has not the batch's */
    r->past.samples += r->under_way;
    r->past.next += r->source->batches;
    return EC_OK;
}
