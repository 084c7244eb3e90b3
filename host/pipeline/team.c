#include "pipeline/team.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

#define LONGEST_PIECE 1.0 /* seconds */
#define TILE 8u           /* kernels/lib/film.h */

/* A batch that is open: some of its positions are done, [handed, count) wait, and members hold the others. */
typedef struct slot {
    const uint32_t *list;
    float *mean, *aov;
    uint32_t count, handed;
    uint32_t invalid[EC_STAGE_COUNT];
} slot;

typedef struct member {
    ec_team *team;
    ec_team_recruit recruit;
    pthread_t thread;
    ec_batch_source *source;
    bool has_thread, is_ready, is_busy, has_failed, is_told;
    slot *slot;                       /* whose piece [first, end) it holds; NULL: none. A failed one's is for the others to take */
    uint32_t first, end, reached;
    uint32_t pieces;
    uint64_t pixels;                  /* in finished pieces */
    double rate;                      /* positions a second of the last piece; 0: not known */
    uint64_t rays;
    uint32_t invalid[EC_STAGE_COUNT]; /* the source's, before the piece */
    ec_error why;
} member;

struct ec_team {
    ec_batch_source base;
    member *members;
    uint32_t count, width;
    uint64_t pixels;
    const ec_log *log;
    pthread_mutex_t lock;
    pthread_cond_t work, news;        /* for members; for who takes batches */
    slot *slots;                      /* batch i is in slots[i % window] */
    uint32_t window, next, opened, end; /* [next, opened) are open; up to end they may be */
    uint32_t taken;                   /* batches before this one have come out */
    uint64_t rays;                    /* in pieces that are over */
    bool stops;
};

uint32_t ec_team_window(uint32_t members, uint64_t pixels)
{
    return 12 * pixels * (members + 1ull) <= EC_TEAM_ROOM ? members + 1 : 2;
}

/* From here on the lock is held. */

static slot *slot_of(const ec_team *t, uint32_t index) { return &t->slots[index % t->window]; }

/* False where there is no memory. */
static bool open_next(ec_team *t, const uint32_t *list, uint32_t count)
{
    slot *s = slot_of(t, t->opened);
    float *mean = s->mean ? s->mean : malloc(12 * t->pixels);
    if (!mean) return false;
    *s = (slot){.mean = mean, .list = list, .count = count};
    t->opened++;
    return true;
}

static uint32_t alive(const ec_team *t)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->count; i++) n += !t->members[i].has_failed;
    return n;
}

/* Seconds that all take for a batch; 0 where one's pace is not known. */
static double batch_seconds(const ec_team *t)
{
    double rate = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        const member *m = &t->members[i];
        if (!m->has_failed && m->is_ready && m->rate == 0) return 0;
        if (!m->has_failed) rate += m->rate;
    }
    return rate > 0 ? (double)t->pixels / rate : 0;
}

static uint32_t piece_of(const member *m, const slot *s)
{
    const ec_team *t = m->team;
    const uint32_t left = s->count - s->handed, unit = s->list ? 1 : TILE * t->width;
    double seconds = batch_seconds(t) * alive(t), size = m->rate * fmin(seconds > 0 ? seconds : LONGEST_PIECE, LONGEST_PIECE);
    if (t->opened >= t->end) size = fmin(size, left / (2.0 * alive(t)));
    size = ceil(fmax(fmax(size, m->source->least), 1) / unit) * unit;
    return size > 0.75 * left ? left : (uint32_t)size;
}

/* A piece that a failed member left behind. */
static bool take_over(member *m, slot *s)
{
    for (uint32_t i = 0; i < m->team->count; i++) {
        member *lost = &m->team->members[i];
        if (!lost->has_failed || lost->slot != s) continue;
        m->slot = s, m->first = lost->first, m->end = lost->end;
        lost->slot = NULL;
        return true;
    }
    return false;
}

static bool find_piece(member *m)
{
    ec_team *t = m->team;
    for (uint32_t index = t->next; index < t->opened; index++) {
        slot *s = slot_of(t, index);
        if (take_over(m, s)) return true;
        if (s->handed == s->count) continue;
        m->slot = s, m->first = s->handed, m->end = s->handed + piece_of(m, s);
        s->handed = m->end;
        return true;
    }
    bool may_open = t->opened > t->next && t->opened < t->end && t->opened - t->next < t->window;
    return may_open && open_next(t, NULL, (uint32_t)t->pixels) && find_piece(m);
}

/* What was given up: of a piece of a first batch the rows that were reached are of use. */
static void give_up(member *m)
{
    slot *s = m->slot;
    const uint32_t unit = s->list ? 1 : TILE * m->team->width, reached = m->first + (m->reached - m->first) / unit * unit;
    for (uint64_t i = reached; i < m->end; i++) s->mean[3 * i] = EC_NOT_REACHED;
    if (m->first < s->handed) s->handed = m->first;
}

static void settle(member *m, ec_result result, bool complete, double seconds)
{
    ec_team *t = m->team;
    m->is_busy = false;
    m->has_failed = result != EC_OK;
    if (m->has_failed) return; /* the piece stays for others */
    t->rays += m->source->rays - m->rays;
    if (!complete) give_up(m);
    for (int i = 0; complete && i < EC_STAGE_COUNT; i++) m->slot->invalid[i] += m->source->invalid[i] - m->invalid[i];
    if (complete) m->pixels += m->end - m->first;
    if (m->pieces++) m->rate = (m->end - m->first) / fmax(seconds, 1e-6); /* compilers slow the first down */
    m->slot = NULL;
}

static bool carries_on(void *user, uint32_t done)
{
    member *m = user;
    pthread_mutex_lock(&m->team->lock);
    m->reached = done;
    bool carries_on = !m->team->stops;
    pthread_mutex_unlock(&m->team->lock);
    return carries_on;
}

/* Without the lock for as long as it takes. */
static void work_piece(member *m)
{
    ec_team *t = m->team;
    uint32_t index = t->next;
    bool complete = false;
    while (slot_of(t, index) != m->slot) index++;
    const ec_batch_order order = {.index = index, .list = m->slot->list, .done = m->first, .count = m->end, .into = m->slot->mean, .aov = m->slot->aov,
                                  .go_on = carries_on, .user = m};
    m->is_busy = true;
    m->reached = m->first;
    m->rays = m->source->rays;
    memcpy(m->invalid, m->source->invalid, sizeof m->invalid);
    pthread_mutex_unlock(&t->lock);
    double start = ec_now();
    ec_result result = m->source->take(m->source, &order, &complete, &m->why);
    double seconds = ec_now() - start;
    pthread_mutex_lock(&t->lock);
    settle(m, result, complete, seconds);
    if (m->has_failed) pthread_cond_broadcast(&t->work); /* its piece is free */
    pthread_cond_signal(&t->news);
}

static void *work(void *user)
{
    member *m = user;
    ec_team *t = m->team;
    ec_result result = m->recruit.open(m->recruit.user, &m->source, &m->why);
    pthread_mutex_lock(&t->lock);
    m->is_ready = result == EC_OK;
    m->has_failed = !m->is_ready;
    pthread_cond_signal(&t->news);
    while (!m->has_failed && !t->stops)
        if (find_piece(m)) work_piece(m);
        else pthread_cond_wait(&t->work, &t->lock);
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

/* All positions before this one are done. */
static uint32_t done_of(const ec_team *t, const slot *s)
{
    uint32_t done = s->handed;
    for (uint32_t i = 0; i < t->count; i++)
        if (t->members[i].slot == s && t->members[i].first < done) done = t->members[i].first;
    return done;
}

static void wait_for_news(ec_team *t)
{
    const struct timespec until = ec_deadline(0.05); /* half of the time between two words of progress */
    pthread_cond_timedwait(&t->news, &t->lock, &until);
}

static ec_result tell_failures(ec_team *t, ec_error *err)
{
    for (uint32_t i = 0; i < t->count; i++) {
        member *m = &t->members[i];
        if (!m->has_failed || m->is_told) continue;
        m->is_told = true;
        if (!alive(t) && err) *err = m->why;
        if (alive(t)) ec_warn(t->log, "%s is out, and the others take over its work: %s", m->recruit.name, m->why.text);
    }
    return alive(t) ? EC_OK : EC_FAILED;
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

/* Until nobody is at work. */
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

static ec_result open_ordered(ec_team *t, const ec_batch_order *order, ec_error *err)
{
    if (order->index < t->taken) t->opened = order->index; /* another piece of one that has come out */
    t->next = order->index;
    t->end = order->end;
    if (t->opened <= order->index) {
        t->opened = order->index;
        if (!open_next(t, order->list, order->count)) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)t->pixels);
        slot *s = slot_of(t, order->index);
        s->handed = order->done;
        s->aov = order->aov;
        if (order->before) memcpy(s->mean, order->before, 12ull * order->count);
        for (uint64_t i = order->done; order->aov && i < order->count; i++) s->mean[3 * i] = EC_NOT_REACHED;
    }
    pthread_cond_broadcast(&t->work);
    return EC_OK;
}

static ec_result wait_for(ec_team *t, const ec_batch_order *order, bool *complete, ec_error *err)
{
    const slot *s = slot_of(t, order->index);
    EC_TRY(open_ordered(t, order, err));
    t->base.mean = s->mean;
    for (uint32_t done = order->done; *complete;) {
        EC_TRY(tell_failures(t, err));
        done = done_of(t, s);
        t->base.rays = t->rays;
        pthread_mutex_unlock(&t->lock);
        *complete = order->go_on(order->user, done) || done == order->count;
        pthread_mutex_lock(&t->lock);
        if (done == order->count) break;
        if (*complete && done_of(t, s) == done) wait_for_news(t);
    }
    if (!*complete) stop(t);
    for (int i = 0; *complete && i < EC_STAGE_COUNT; i++) t->base.invalid[i] += s->invalid[i];
    if (*complete) t->taken = order->index + 1;
    return EC_OK;
}

static ec_result take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_team *t = (ec_team *)source;
    *complete = true;
    pthread_mutex_lock(&t->lock);
    ec_result result = wait_for(t, order, complete, err);
    pthread_mutex_unlock(&t->lock);
    return result;
}

/* What members have done is there already. */
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
    for (uint32_t i = 0; i < t->window; i++) free(t->slots[i].mean), t->slots[i].mean = NULL;
    t->base.mean = NULL;
}

ec_batch_source *ec_team_source(ec_team *team) { return &team->base; }

uint64_t ec_team_share(const ec_team *team, uint32_t i, bool *has_failed)
{
    *has_failed = i >= team->count || team->members[i].has_failed;
    return i < team->count ? team->members[i].pixels : 0;
}

ec_result ec_team_open(const ec_team_recruit *recruits, uint32_t count, uint32_t width, uint32_t height, const ec_log *log, ec_team **team,
                       ec_error *err)
{
    ec_team *t = *team = calloc(1, sizeof *t);
    if (!t) return ec_fail(err, "out of memory for a team of %u devices", count);
    *t = (ec_team){.base = {.take = take, .look = look, .close = close_team}, .width = width, .pixels = (uint64_t)width * height, .log = log};
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->work, NULL);
    pthread_cond_init(&t->news, NULL);
    t->members = calloc(count, sizeof *t->members);
    t->slots = calloc(count + 1, sizeof *t->slots);
    if (!t->members || !t->slots) return ec_fail(err, "out of memory for a team of %u devices", count);
    t->window = ec_team_window(count, t->pixels);
    t->count = count;
    for (uint32_t i = 0; i < count; i++) {
        member *m = &t->members[i];
        *m = (member){.team = t, .recruit = recruits[i]};
    }
    for (uint32_t i = 0; i < count; i++) {
        member *m = &t->members[i];
        m->has_thread = pthread_create(&m->thread, NULL, work, m) == 0;
        if (!m->has_thread) return ec_fail(err, "cannot start a thread for %s", m->recruit.name);
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
