#include "ranks/ranks_internal.h"

#include <stdlib.h>
#include <string.h>

static void end(ec_remote *m)
{
    const ec_message over = {.kind = EC_ORDER_END, .box = EC_BOX_ORDERS};
    if (!m->is_over) (void)ec_transport_send(m->ranks->transport, m->rank, &over, NULL);
    m->is_over = true;
}

static uint32_t write_order(ec_remote *m, const ec_batch_order *order, ec_message *message)
{
    const uint32_t *list = order->list ? order->list + (uint64_t)EC_LIST_WORDS * order->done : NULL;
    *message = (ec_message){.kind = EC_ORDER_BATCH, .box = EC_BOX_ORDERS, .body = (void *)list, .bytes = list ? 4ull * EC_LIST_WORDS * (order->count - order->done) : 0};
    pthread_mutex_lock(&m->ranks->lock);
    const uint32_t box = ++m->ranks->last_box; /* a new box, so that answers to abandoned orders are ignored */
    pthread_mutex_unlock(&m->ranks->lock);
    message->numbers[EC_ORDER_BOX] = box;
    message->numbers[EC_ORDER_LIGHT] = order->light;
    message->numbers[EC_ORDER_INDEX] = order->index;
    message->numbers[EC_ORDER_BATCHES] = order->batches;
    message->numbers[EC_ORDER_CUT] = order->cut;
    message->numbers[EC_ORDER_SAMPLES] = order->samples;
    message->numbers[EC_ORDER_FROM] = order->done;
    message->numbers[EC_ORDER_TO] = order->count;
    memcpy(&message->numbers[EC_ORDER_LIMIT], &order->limit, sizeof order->limit);
    message->numbers[EC_ORDER_FEATURES] = order->feature_sets;
    return box;
}

typedef struct waiting {
    const ec_batch_order *order;
    bool given_up;
} waiting;

static bool waits_on(void *user)
{
    waiting *w = user;
    w->given_up = !w->order->go_on(w->order->user, w->order->done);
    return !w->given_up;
}

/* Sends the order and waits for the result; *complete false: it was abandoned. */
static ec_result fetch(ec_remote *m, const ec_batch_order *order, ec_message *back, bool *complete, ec_error *err)
{
    ec_message message;
    waiting w = {.order = order};
    const uint32_t box = write_order(m, order, &message);
    *complete = true;
    EC_TRY(ec_transport_send(m->ranks->transport, m->rank, &message, err));
    ec_result result = ec_transport_receive(m->ranks->transport, m->rank, box, waits_on, &w, back, err);
    if (w.given_up && result != EC_OK) {
        end(m);
        *complete = false;
        return EC_OK;
    }
    EC_TRY(result);
    if (back->kind == EC_RESULT_BATCH && back->body) return EC_OK;
    ec_fail(err, "%s", back->body ? (const char *)back->body : "out of memory");
    if (err) err->kind = EC_ERROR_DEVICE;
    free(back->body);
    return EC_FAILED;
}

static void count(ec_remote *m, const ec_message *back)
{
    m->base.rays += back->numbers[EC_RESULT_RAYS];
    m->base.least = (uint32_t)back->numbers[EC_RESULT_LEAST];
    for (int i = 0; i < EC_STAGE_COUNT; i++) m->base.invalid[i] += (uint32_t)back->numbers[EC_RESULT_INVALID + i];
}

static ec_result take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_remote *m = (ec_remote *)source;
    const uint64_t positions = order->count - order->done;
    ec_message back;
    EC_TRY(fetch(m, order, &back, complete, err));
    if (!*complete) return EC_OK;
    count(m, &back);
    if (order->batches > 1) {
        const ec_sums sums = ec_sums_in(back.body, order->sums->replicates, order->feature_sets, positions);
        ec_sums_copy(order->sums, &sums, positions);
    } else {
        memcpy(order->into, back.body, 4 * EC_BATCH_FIELDS * positions);
        if (order->feature_sets) memcpy(order->features_into, (float *)back.body + EC_BATCH_FIELDS * positions, 4 * EC_AOV_FIELDS * positions);
    }
    free(back.body);
    return EC_OK;
}

static void close_remote(ec_batch_source *source)
{
    end((ec_remote *)source);
}

static ec_result open_remote(void *user, ec_batch_source **source, ec_error *err)
{
    ec_remote *m = user;
    (void)err;
    m->base = (ec_batch_source){.take = take, .close = close_remote};
    m->is_over = false;
    *source = &m->base;
    return EC_OK;
}

bool ec_ranks_candidate(void *user, uint32_t i, ec_team_candidate *candidate)
{
    ec_remote *m = &((ec_ranks *)user)->remotes[i];
    *candidate = (ec_team_candidate){.name = m->name, .open = open_remote, .user = m, .processes = m->ready};
    return m->is_ready;
}
