/* The threads of a team, and the orders that it is given. */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "film/parts.h"
#include "device/fold.h"
#include "render/team_internal.h"

static bool carries_on(void *user, uint32_t done)
{
    member *m = user;
    pthread_mutex_lock(&m->team->lock);
    m->reached = done;
    bool carries_on = !m->team->stops;
    pthread_mutex_unlock(&m->team->lock);
    return carries_on;
}

/* Works on the member's piece, without the lock. */
static void work_piece(member *m)
{
    ec_team *t = m->team;
    const slot *s = m->slot;
    const bool is_block = s->batches > 1;
    const ec_sums sums = is_block ? ec_sums_from(&s->sums, m->first - s->from) : (ec_sums){0};
    const ec_batch_order order = {.light = s->light, .index = s->index, .batches = s->batches, .cut = s->cut, .list = s->list, .samples = s->samples,
                                  .limit = s->limit, .done = m->first, .count = m->end, .layers = s->layers, .matte = s->matte,
                                  .into = is_block ? NULL : s->mean + (uint64_t)EC_BATCH_FIELDS * m->first, .feature_sets = s->feature_sets,
                                  .features_into = is_block || !s->feature_sets ? NULL : s->features + (uint64_t)EC_AOV_FIELDS * m->first, .sums = is_block ? &sums : NULL,
                                  .go_on = carries_on, .user = m};
    bool complete = false;
    m->is_busy = true;
    m->reached = m->first;
    m->rays = m->source->rays;
    memcpy(m->invalid, m->source->invalid, sizeof m->invalid);
    pthread_mutex_unlock(&t->lock);
    double start = ec_now();
    ec_result result = m->source->take(m->source, &order, &complete, &m->why);
    double seconds = ec_now() - start;
    pthread_mutex_lock(&t->lock);
    ec_team_settle(m, result, complete, seconds);
    if (m->has_failed) pthread_cond_broadcast(&t->work); /* others may take its piece */
    pthread_cond_signal(&t->news);
}

static void *work(void *user)
{
    member *m = user;
    ec_team *t = m->team;
    ec_result result = m->candidate.open(m->candidate.user, &m->source, &m->why);
    pthread_mutex_lock(&t->lock);
    m->is_ready = result == EC_OK;
    m->has_failed = !m->is_ready;
    pthread_cond_signal(&t->news);
    while (!m->has_failed && !t->stops)
        if (ec_team_find_piece(m)) work_piece(m);
        else pthread_cond_wait(&t->work, &t->lock);
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

static void wait_for_news(ec_team *t)
{
    const struct timespec until = ec_deadline(0.05); /* half of the time between two reports of progress */
    pthread_cond_timedwait(&t->news, &t->lock, &until);
}

static ec_result tell_failures(ec_team *t, ec_error *err)
{
    for (uint32_t i = 0; i < t->count; i++) {
        member *m = &t->members[i];
        if (!m->has_failed || m->is_told) continue;
        m->is_told = true;
        if (!ec_team_alive(t) && err) *err = m->why;
        if (ec_team_alive(t)) ec_warn(t->log, "%s has failed, and the others take over its work: %s", m->candidate.name, m->why.text);
    }
    return ec_team_alive(t) ? EC_OK : EC_FAILED;
}

void ec_team_wait(ec_team *t, uint32_t count)
{
    bool waits = count > 0;
    pthread_mutex_lock(&t->lock);
    while (waits) {
        bool any = false, all_failed = true;
        for (uint32_t i = 0; i < count; i++) any |= t->members[i].is_ready, all_failed &= t->members[i].has_failed;
        waits = !any && !all_failed;
        if (waits) wait_for_news(t);
    }
    pthread_mutex_unlock(&t->lock);
}

bool ec_team_is_ready(ec_team *t, uint32_t i, bool waits)
{
    const member *m = &t->members[i];
    pthread_mutex_lock(&t->lock);
    while (waits && !m->is_ready && !m->has_failed) wait_for_news(t);
    const bool is_ready = m->is_ready && !m->has_failed;
    pthread_mutex_unlock(&t->lock);
    return is_ready;
}

void ec_team_leave_out(ec_team *t, uint32_t i, const ec_error *why)
{
    pthread_mutex_lock(&t->lock);
    t->members[i].has_failed = true;
    t->members[i].why = *why;
    pthread_cond_broadcast(&t->work);
    pthread_mutex_unlock(&t->lock);
}

/* Stops the members, and waits until none is busy. */
static void stop(ec_team *t)
{
    t->stops = true;
    pthread_cond_broadcast(&t->work);
    for (bool busy = true; busy;) {
        busy = false;
        for (uint32_t i = 0; i < t->count; i++) busy |= t->members[i].is_busy;
        if (busy) wait_for_news(t);
    }
}

/* Returns the unit that is ordered: one that was begun ahead, or a new one. */
static slot *open_ordered(ec_team *t, const ec_batch_order *order)
{
    if (t->is_out) t->next++;
    t->is_out = false;
    t->end = order->end;
    t->step = order->batches;
    t->done = order->batches ? order->done : 0;
    t->last = order->batches ? order->count : (uint32_t)t->pixels;
    t->limit = order->limit;
    t->feature_sets = order->feature_sets;
    t->whole = order->whole;
    t->user = order->user;
    t->patience = order->patience;
    t->until = order->until;
    if (t->next == t->opened || t->slots[t->next % t->room].index != order->index) {
        t->next = t->opened;
        if (!ec_team_open_unit(t, order)) return NULL;
    }
    pthread_cond_broadcast(&t->work);
    return &t->slots[t->next % t->room];
}

/* Hands out a unit that is whole. */
static void hand_out(ec_team *t, slot *s)
{
    for (int i = 0; i < EC_STAGE_COUNT; i++) t->base.invalid[i] += s->invalid[i];
    ec_sums_destroy(&t->base.sums);
    t->base.sums = s->sums;
    s->sums = (ec_sums){0};
    t->is_out = true;
}

static ec_result wait_for(ec_team *t, const ec_batch_order *order, bool *complete, ec_error *err)
{
    slot *s = open_ordered(t, order);
    if (!s) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)t->pixels);
    t->base.mean = s->mean;
    t->base.features = s->features;
    t->base.batches = s->batches;
    for (uint32_t done = order->done; *complete;) {
        EC_TRY(tell_failures(t, err));
        done = ec_team_done(t, s);
        t->base.rays = t->rays;
        pthread_mutex_unlock(&t->lock);
        *complete = order->go_on(order->user, done) || done == order->count;
        pthread_mutex_lock(&t->lock);
        if (done == order->count) break;
        if (*complete && ec_team_done(t, s) == done) wait_for_news(t);
    }
    if (*complete) hand_out(t, s);
    else stop(t);
    t->base.reached = order->count;
    return EC_OK;
}

static ec_result take_unit(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_team *t = (ec_team *)source;
    *complete = true;
    pthread_mutex_lock(&t->lock);
    ec_result result = wait_for(t, order, complete, err);
    pthread_mutex_unlock(&t->lock);
    return result;
}

/* Takes an order. A block is made of smaller ones, so that all members have something to do even if its positions are few. */
static ec_result take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    const ec_fold_parts parts = {.batches = ec_fold_step(order->batches), .take = take_unit};
    if (order->batches <= 1) return take_unit(source, order, complete, err);
    return ec_fold_block(source, order, ((ec_team *)source)->replicates, &parts, &source->invalid[EC_STAGE_ACCUMULATE], complete, err);
}

/* Nothing to do: what members have done is there already. */
static ec_result look(ec_batch_source *source, const ec_batch_order *order, ec_error *err)
{
    (void)source, (void)order, (void)err;
    return EC_OK;
}

static void close_team(ec_batch_source *source)
{
    ec_team *t = (ec_team *)source;
    pthread_mutex_lock(&t->lock);
    t->stops = true;
    pthread_cond_broadcast(&t->work);
    pthread_mutex_unlock(&t->lock);
    for (uint32_t i = 0; i < t->count; i++) {
        member *m = &t->members[i];
        if (m->has_thread) pthread_join(m->thread, NULL);
        m->has_thread = false;
        if (m->source) m->source->close(m->source);
        m->source = NULL;
    }
    (void)tell_failures(t, NULL);
    t->next = t->opened;
    ec_team_free_units(t);
    ec_sums_destroy(&t->base.sums);
    t->base.mean = t->base.features = NULL;
}

ec_batch_source *ec_team_source(ec_team *team) { return &team->base; }

double ec_team_share(const ec_team *team, uint32_t i, bool *has_failed)
{
    *has_failed = i >= team->count || team->members[i].has_failed;
    return i < team->count ? team->members[i].samples : 0;
}

ec_result ec_team_open(const ec_team_candidate *candidates, uint32_t count, uint32_t width, uint32_t height,
                       uint32_t replicates, const ec_log *log, ec_team **team, ec_error *err)
{
    uint32_t sources = 0;
    ec_team *t = *team = calloc(1, sizeof *t);
    if (!t) return ec_fail(err, "out of memory for a team of %u devices", count);
    *t = (ec_team){.base = {.take = take, .look = look, .close = close_team}, .width = width, .replicates = replicates,
                    .pixels = (uint64_t)width * height, .log = log};
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->work, NULL);
    pthread_cond_init(&t->news, NULL);
    t->members = calloc(count, sizeof *t->members);
    for (uint32_t i = 0; i < count; i++) sources += candidates[i].processes ? candidates[i].processes : 1;
    t->room = ec_team_window(sources, t->pixels, 4 * EC_BATCH_FIELDS);
    t->slots = calloc(t->room, sizeof *t->slots);
    if (!t->members || !t->slots) return ec_fail(err, "out of memory for a team of %u devices", count);
    t->count = count;
    for (uint32_t i = 0; i < count; i++) {
        member *m = &t->members[i];
        *m = (member){.team = t, .candidate = candidates[i]};
        t->sends |= m->candidate.processes > 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        member *m = &t->members[i];
        m->has_thread = pthread_create(&m->thread, NULL, work, m) == 0;
        if (!m->has_thread) return ec_fail(err, "cannot start a thread for %s", m->candidate.name);
    }
    return EC_OK;
}

void ec_team_free(ec_team *team)
{
    if (!team) return;
    if (team->members && team->slots) close_team(&team->base);
    pthread_cond_destroy(&team->work);
    pthread_cond_destroy(&team->news);
    pthread_mutex_destroy(&team->lock);
    free(team->members);
    free(team->slots);
    free(team);
}
