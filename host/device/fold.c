#include "device/fold.h"

#include <stdlib.h>

#include "film/film.h"

static void deliver(ec_batch_source *source, const ec_batch_order *order, ec_film *film)
{
    ec_sums sums = ec_film_give_sums(film);
    if (order->sums) {
        ec_sums_copy(order->sums, &sums, order->count - order->done);
        ec_sums_destroy(&sums);
    } else {
        ec_sums_destroy(&source->sums);
        source->sums = sums;
    }
}

/* Adds what a part came to. */
static ec_result add(ec_batch_source *source, const ec_batch_order *part, ec_film *film, ec_error *err)
{
    ec_film_part sums = {.first = part->index, .count = part->batches, .sums = source->sums};
    const ec_film_batch batch = {.index = part->index,
                                 .values = part->into ? part->into : source->mean + (uint64_t)EC_BATCH_FIELDS * part->done,
                                 .features = !part->feature_sets ? NULL : part->features_into ? part->features_into : source->features + (uint64_t)EC_AOV_FIELDS * part->done};
    if (part->batches == 1) return ec_film_take(film, &batch, err);
    EC_TRY(ec_film_insert(film, &sums, err));
    source->sums = (ec_sums){0};
    return EC_OK;
}

/* Takes the parts one after the other, and adds them. */
static ec_result add_up(ec_batch_source *source, const ec_batch_order *order, const ec_fold_parts *parts, float *into, float *features,
                        ec_film *film, bool *complete, ec_error *err)
{
    const uint32_t end = order->index + order->batches;
    for (uint32_t index = order->index; index < end && *complete; index += parts->batches) {
        const ec_batch_order part = {.index = index, .end = end, .batches = parts->batches, .done = order->done, .count = order->count, .into = into,
                                     .feature_sets = order->feature_sets, .features_into = features, .limit = order->limit, .go_on = order->go_on, .user = order->user};
        EC_TRY(parts->take(source, &part, complete, err));
        if (*complete) EC_TRY(add(source, &part, film, err));
    }
    return EC_OK;
}

ec_result ec_fold_block(ec_batch_source *source, const ec_batch_order *order, uint32_t replicates, const ec_fold_parts *parts,
                        uint32_t *unfit, bool *complete, ec_error *err)
{
    const uint32_t positions = order->count - order->done;
    const bool want_features = parts->want_room && order->feature_sets;
    float *batch = parts->want_room ? malloc(4ull * EC_BATCH_FIELDS * positions) : NULL, *features = want_features ? malloc(4ull * EC_AOV_FIELDS * positions) : NULL;
    const bool has_room = (batch || !parts->want_room) && (features || !want_features);
    ec_film film = {0};
    *complete = true;
    ec_result result = has_room ? ec_film_create(&film, positions, 1, replicates, err) : ec_fail(err, "out of memory for a batch of %u pixels", positions);
    ec_film_want_features(&film, order->feature_sets, UINT32_MAX);
    if (result == EC_OK) result = add_up(source, order, parts, batch, features, &film, complete, err);
    if (result == EC_OK && *complete) {
        deliver(source, order, &film);
        *unfit += (uint32_t)film.invalid_count;
    }
    source->batches = order->batches;
    ec_film_destroy(&film);
    free(batch);
    free(features);
    return result;
}
