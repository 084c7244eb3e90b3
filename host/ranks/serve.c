/* Serves jobs on ranks other than 0, one after the other, until they are dismissed. A rank's devices and its children form a team. */
#include <string.h>

#include "base/freed.h"
#include "render/sources.h"
#include "ranks/ranks_internal.h"

typedef struct server {
    ec_ranks *ranks;
    const ec_log *log;
    ec_sources sources;
    ec_batch_source *source;  /* its devices and all ranks below */
    uint64_t pixels;
    uint32_t replicates;
} server;

/* Tells whether the job goes on: the next message means its end. */
static bool goes_on(void *user, uint32_t done)
{
    const server *s = user;
    (void)done;
    return !ec_transport_has(s->ranks->transport, s->ranks->place->parent, EC_BOX_ORDERS);
}

/* Writes the results of an order, from position `first` on, in the form in which they are sent. */
static void write_body(const server *s, const ec_batch_order *order, void *body)
{
    const ec_batch_source *source = s->source;
    const uint64_t first = order->done, positions = order->count - first;
    if (order->batches > 1) {
        const ec_sums sums = ec_sums_in(body, source->sums.replicates, order->feature_sets, positions);
        ec_sums_copy(&sums, &source->sums, positions);
        return;
    }
    memcpy(body, source->mean + EC_BATCH_FIELDS * first, 4 * EC_BATCH_FIELDS * positions);
    if (order->feature_sets)
        memcpy((float *)body + EC_BATCH_FIELDS * positions, source->features + EC_AOV_FIELDS * first, 4 * EC_AOV_FIELDS * positions);
}

/* Renders an order. The answer's body is malloc'ed; it stays NULL if the job was ended meanwhile. */
static ec_result render(server *s, const ec_message *message, ec_message *answer, ec_error *err)
{
    ec_batch_source *source = s->source;
    const uint32_t index = (uint32_t)message->numbers[EC_ORDER_INDEX], from = (uint32_t)message->numbers[EC_ORDER_FROM];
    const uint32_t batches = (uint32_t)message->numbers[EC_ORDER_BATCHES];
    const uint32_t positions = (uint32_t)message->numbers[EC_ORDER_TO] - from, first = message->body ? 0 : from;
    const uint32_t sets = (uint32_t)message->numbers[EC_ORDER_FEATURES];
    const uint64_t bytes = (batches > 1 ? ec_sums_bytes(s->replicates, sets) : ec_batch_bytes(sets)) * positions;
    EC_FREED float *body = malloc(bytes);
    if (!body) return ec_fail(err, "out of memory for a batch of %u pixels", positions);
    float limit;
    memcpy(&limit, &message->numbers[EC_ORDER_LIMIT], sizeof limit);
    const ec_batch_order order = {.light = (ec_order_light)message->numbers[EC_ORDER_LIGHT], .index = index, .end = index + batches, .batches = batches, .cut = (uint32_t)message->numbers[EC_ORDER_CUT],
                                  .list = message->body, .samples = (uint32_t)message->numbers[EC_ORDER_SAMPLES], .done = first,
                                  .count = first + positions, .limit = limit, .feature_sets = sets, .go_on = goes_on, .user = s};
    const uint64_t rays = source->rays;
    uint32_t invalid[EC_STAGE_COUNT];
    bool complete = false;
    memcpy(invalid, source->invalid, sizeof invalid);
    EC_TRY(source->take(source, &order, &complete, err));
    answer->numbers[EC_RESULT_RAYS] = source->rays - rays;
    answer->numbers[EC_RESULT_LEAST] = source->least;
    for (int i = 0; i < EC_STAGE_COUNT; i++) answer->numbers[EC_RESULT_INVALID + i] = source->invalid[i] - invalid[i];
    if (!complete) return EC_OK;
    write_body(s, &order, body);
    answer->body = body;
    answer->bytes = bytes;
    body = NULL;
    return EC_OK;
}

/* Fills in the answer; a failure is reported to the parent, which decides what follows. Returns false if there is nothing to answer. */
static bool fill_answer(server *s, const ec_message *message, const ec_error *unfit, ec_message *answer)
{
    ec_error why = *unfit;
    *answer = (ec_message){.kind = EC_RESULT_BATCH, .box = (uint32_t)message->numbers[EC_ORDER_BOX]};
    if (!*why.text && render(s, message, answer, &why) == EC_OK) return answer->body != NULL;
    answer->kind = EC_RESULT_FAILURE;
    answer->body = strdup(why.text);
    answer->bytes = answer->body ? strlen(why.text) + 1 : 0;
    return true;
}

static ec_result take_orders(server *s, const ec_error *unfit, ec_error *err)
{
    const int parent = s->ranks->place->parent;
    for (;;) {
        ec_message message, answer;
        EC_TRY(ec_transport_receive(s->ranks->transport, parent, EC_BOX_ORDERS, NULL, NULL, &message, err));
        if (message.kind == EC_ORDER_END) return EC_OK;
        if (fill_answer(s, &message, unfit, &answer)) ec_transport_send_away(s->ranks->transport, parent, &answer);
        free(message.body);
    }
}

/* Logs warnings, which are not sent to other ranks. */
static void pass_on(void *user, ec_severity severity, const char *text)
{
    const server *s = user;
    if (severity == EC_WARNING) ec_warn(s->log, "from rank %d: %s", s->ranks->place->rank, text);
}

/* Opens the devices that can be opened. If there are none, fails with the last one's reason, unless there are ranks below. */
static ec_result open_devices(const ec_device_info *infos, uint32_t *count, ec_cl *devices, bool is_inner,
                              const ec_log *log, ec_error *err)
{
    uint32_t opened = 0;
    for (uint32_t i = 0; i < *count; i++) {
        ec_error why = {0};
        if (ec_cl_open_beside(&infos[i], devices, opened, &devices[opened], &why) == EC_OK) opened++;
        else if (opened || is_inner || i + 1 < *count)
            ec_warn(log, "%s has failed, and the others take over its work: %s", infos[i].name, why.text);
        else *err = why;
    }
    *count = opened;
    return opened || is_inner ? EC_OK : EC_FAILED;
}

/* Does nothing, as the ranks below have the payload already. */
static ec_result send_nothing(void *user, const ec_payload *payload, uint64_t seed, const ec_log *log, ec_error *err)
{
    (void)user, (void)payload, (void)seed, (void)log, (void)err;
    return EC_OK;
}

static bool is_any_ready(const ec_ranks *r)
{
    bool any = false;
    for (uint32_t i = 0; i < r->remote_count; i++) any |= r->remotes[i].is_ready;
    return any;
}

static ec_result serve_job(ec_ranks *r, const ec_message *word, const ec_log *log, ec_error *err)
{
    server s = {.ranks = r, .log = log};
    ec_cl devices[EC_DEVICES_MOST] = {0};
    ec_device_info infos[EC_DEVICES_MOST];
    ec_render_stats stats = {0};
    ec_error why = {0};
    uint32_t count;
    uint64_t seed;
    ec_result result = ec_job_receive(r, word, &s.sources.payload, &seed, infos, &count, err);
    const bool is_inner = is_any_ready(r);
    const ec_peers below = {.count = r->remote_count, .send = send_nothing, .candidate = ec_ranks_candidate, .user = r};
    const ec_log told = {pass_on, &s};
    if (result == EC_OK && (count || is_inner)) {
        const ec_params *params = &s.sources.payload.head.params;
        s.pixels = (uint64_t)params->width * params->height;
        s.replicates = s.sources.payload.head.replicates;
        bool fit = open_devices(infos, &count, devices, is_inner, &told, &why) == EC_OK &&
                   ec_sources_enlist(devices, count, s.sources.payload.head.lanes, &s.sources, &stats, &why) == EC_OK &&
                   ec_sources_open(&s.sources, seed, is_inner ? &below : NULL, &told, &s.source, &stats, &why) == EC_OK &&
                   (!s.source->turn_to || s.source->turn_to(s.source, 0, params->height, &why) == EC_OK);
        if (!fit && !*why.text) ec_fail(&why, "its device failed");
        result = take_orders(&s, &why, err);
    }
    ec_sources_close(&s.sources, &stats);
    for (uint32_t i = 0; i < EC_DEVICES_MOST; i++) ec_cl_close(&devices[i]);
    return result;
}

ec_result ec_mpi_serve(ec_ranks *r, const ec_log *log, ec_error *err)
{
    for (;;) {
        ec_message word;
        EC_TRY(ec_transport_receive(r->transport, r->place->parent, EC_BOX_WORD, NULL, NULL, &word, err));
        ec_result result = word.kind == EC_WORD_JOB ? serve_job(r, &word, log, err) : EC_OK;
        free(word.body);
        if (word.kind == EC_WORD_HOME || result != EC_OK) return result;
    }
}
