/* Open batches and blocks, and their pieces. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "film/parts.h"
#include "device/fold.h"
#include "render/team_internal.h"

uint32_t ec_team_window(uint32_t members, uint64_t pixels, uint64_t bytes)
{
    const uint64_t unit = pixels * bytes, fit = unit ? EC_TEAM_ROOM / unit : members;
    return fit > members ? members + 1 : fit > 2 ? (uint32_t)fit : 2;
}

uint64_t ec_team_bytes(uint32_t members, uint64_t pixels, uint32_t replicates, uint32_t sets, bool from_afar)
{
    const uint64_t batch = ec_batch_bytes(sets), sums = ec_sums_bytes(replicates, sets);
    const uint64_t batches = batch * pixels * ec_team_window(members, pixels, batch);
    const uint64_t blocks = from_afar ? 2 * sums * pixels * ec_team_window(members, pixels, sums) : 0;
    return blocks > batches ? blocks : batches;
}

uint32_t ec_team_alive(const ec_team *t)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->count; i++) n += !t->members[i].has_failed;
    return n;
}

double ec_team_samples(const ec_team *t, const slot *s)
{
    if (s->list) return s->samples;
    return (double)(ec_schedule_samples(t->replicates, s->index + s->batches) - ec_schedule_samples(t->replicates, s->index)) - s->cut;
}

/* Returns the samples a second of all members, without one if that is not NULL; 0 if the pace of any is not known. */
static double rate_without(const ec_team *t, const member *without)
{
    double rate = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        const member *m = &t->members[i];
        if (m == without || m->has_failed) continue;
        if (m->is_ready && m->rate == 0) return 0;
        rate += m->rate;
    }
    return rate;
}

/* Returns the seconds that all members take for so many samples of every pixel; 0 if the pace of any is not known. */
static double seconds_for(const ec_team *t, double samples)
{
    const double rate = rate_without(t, NULL);
    return rate > 0 ? (double)t->pixels * samples / rate : 0;
}

/* Returns how long the smallest piece that is worth its launches takes the member that is slowest at it. */
static double least_seconds(const ec_team *t, double samples)
{
    double most = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        const member *m = &t->members[i];
        if (!m->has_failed && m->rate > 0) most = fmax(most, samples * fmin(m->source->least, (double)t->pixels) / m->rate);
    }
    return most;
}

/* Returns whether a block is over soon, including its last piece, and whether there is enough left for all members to do until the end beside its
 * pieces. */
static bool is_soon(const ec_team *t, uint32_t index, uint32_t batches)
{
    const slot block = {.index = index, .batches = batches}, rest = {.index = index, .batches = t->end - index};
    const double unit = seconds_for(t, ec_team_samples(t, &block)), least = least_seconds(t, ec_team_samples(t, &block));
    const double piece = fmax(fmin(unit * ec_team_alive(t), EC_TEAM_PIECE_SECONDS), least), over = unit + piece;
    return unit > 0 && over <= t->patience && ec_now() + over <= t->until && 2 * least <= seconds_for(t, ec_team_samples(t, &rest));
}

/* Returns how many batches from `index` on make the next unit. */
static uint32_t unit_from(const ec_team *t, uint32_t index)
{
    if (!t->sends || !t->whole) return 1;
    const uint32_t whole = t->whole(t->user, index);
    for (uint32_t n = EC_BLOCK_MOST; n >= EC_FILM_FIRST; n /= EC_FILM_RADIX)
        if (index % n == 0 && n <= whole && n <= t->end - index && is_soon(t, index, n)) return n;
    return 1;
}

static void free_unit(slot *s)
{
    free(s->mean);
    free(s->features);
    ec_sums_destroy(&s->sums);
    s->mean = s->features = NULL;
}

void ec_team_free_units(ec_team *t)
{
    for (uint32_t i = t->opened; i < t->next + t->room; i++) free_unit(&t->slots[i % t->room]);
}

/* Allocates a unit's memory; for batches it takes that of an earlier one. */
static bool make_room(ec_team *t, slot *s)
{
    if (s->batches <= 1) {
        ec_sums_destroy(&s->sums);
        if (!s->mean) s->mean = malloc(4 * EC_BATCH_FIELDS * ec_order_positions(t->pixels, t->replicates));
        if (!s->feature_sets) free(s->features), s->features = NULL;
        else if (!s->features) s->features = malloc(4 * EC_AOV_FIELDS * ec_order_positions(t->pixels, t->replicates));
        return s->mean && (s->features || !s->feature_sets);
    }
    ec_team_free_units(t);
    return ec_sums_create(&s->sums, t->replicates, s->feature_sets, s->count - s->from);
}

static bool open_unit(ec_team *t, const slot *unit)
{
    slot *s = &t->slots[t->opened % t->room];
    float *mean = s->mean, *features = s->features;
    ec_sums_destroy(&s->sums);
    *s = *unit;
    s->mean = mean;
    s->features = features;
    if (!make_room(t, s)) return false;
    t->opened++;
    t->from = s->index + s->batches;
    return true;
}

bool ec_team_open_unit(ec_team *t, const ec_batch_order *o)
{
    slot unit = {.light = o->light, .index = o->index, .batches = o->batches, .cut = o->cut, .list = o->list, .samples = o->samples, .limit = o->limit, .feature_sets = o->feature_sets, .layers = o->layers,
                 .matte = o->matte, .from = o->done, .count = o->count, .handed = o->done};
    const bool may_choose = o->light == EC_LIGHT_ADDED && !o->batches && !o->list && !o->layers && !o->matte && !o->done && !o->cut;
    if (!unit.batches) unit.batches = may_choose ? unit_from(t, o->index) : 1;
    if (!open_unit(t, &unit)) return false;
    const slot *s = &t->slots[(t->opened - 1) % t->room];
    if (o->before) memcpy(s->mean, o->before, 4ull * EC_BATCH_FIELDS * o->done);
    if (o->features_before && s->features) memcpy(s->features, o->features_before, 4ull * EC_AOV_FIELDS * o->done);
    for (uint64_t i = o->done; s->mean && o->index == 0 && i < o->count; i++) s->mean[EC_BATCH_FIELDS * i] = EC_NOT_REACHED;
    return true;
}

static uint64_t bytes_of(const ec_team *t, uint32_t batches)
{
    return t->pixels * (batches > 1 ? ec_sums_bytes(t->replicates, t->feature_sets) : ec_batch_bytes(t->feature_sets));
}

static bool has_room(const ec_team *t, uint32_t batches)
{
    uint64_t bytes = bytes_of(t, batches);
    for (uint32_t i = t->next; i < t->opened; i++) bytes += bytes_of(t, t->slots[i % t->room].batches);
    return t->opened - t->next < (bytes <= EC_TEAM_ROOM ? t->room : 2);
}

/* Opens a unit that will be ordered, ahead of its order. */
static bool open_ahead(ec_team *t)
{
    if (t->opened == t->next || t->from >= t->end) return false;
    const slot unit = {.index = t->from, .batches = t->step ? t->step : unit_from(t, t->from), .from = t->done, .handed = t->done, .count = t->last,
                       .limit = t->limit, .feature_sets = t->feature_sets};
    return has_room(t, unit.batches) && open_unit(t, &unit);
}

static uint32_t piece_of(const member *m, const slot *s)
{
    const ec_team *t = m->team;
    const uint32_t left = s->count - s->handed, unit = s->list ? 1 : EC_TILE_ROWS * t->width, alive = ec_team_alive(t);
    const double samples = ec_team_samples(t, s);
    double seconds = seconds_for(t, samples) * alive,
           size = m->rate / samples * fmin(seconds > 0 ? seconds : EC_TEAM_PIECE_SECONDS, EC_TEAM_PIECE_SECONDS);
    if (t->from >= t->end) size = fmin(size, left / (2.0 * alive));
    if (s->batches > 1) size = fmin(size, (double)(EC_TEAM_PIECE / ec_sums_bytes(t->replicates, s->feature_sets)));
    size = ceil(fmax(fmax(size, m->source->least), 1) / unit) * unit;
    return size > 0.75 * left ? left : (uint32_t)size;
}

/* Takes over a piece that a failed member left behind. */
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

/* Returns whether the others would do all that may be open before this member were done with its smallest piece: they would only wait for it. A wave
 * takes it no longer than its last piece did, where waves cost what their launches do, so it is asked again as batches grow. */
static bool holds_up(const member *m, const slot *s)
{
    const ec_team *t = m->team;
    const double samples = ec_team_samples(t, s), positions = s->count, open = fmax(t->room, ec_team_alive(t) + 1); /* one of them does not hold up */
    return m->rate > 0 && fmin(m->seconds, samples * fmin(m->source->least, positions) / m->rate) * rate_without(t, m) > samples * positions * open;
}

bool ec_team_find_piece(member *m)
{
    ec_team *t = m->team;
    for (uint32_t i = t->next; i < t->opened; i++) {
        slot *s = &t->slots[i % t->room];
        if (take_over(m, s)) return true;
        if (s->handed == s->count || holds_up(m, s)) continue;
        m->slot = s, m->first = s->handed, m->end = s->handed + piece_of(m, s);
        s->handed = m->end;
        return true;
    }
    return open_ahead(t) && ec_team_find_piece(m);
}

/* Gives up a piece: if it is of a first batch, the rows that were reached are of use. */
static void give_up(member *m)
{
    slot *s = m->slot;
    const uint32_t unit = s->list ? 1 : EC_TILE_ROWS * m->team->width, reached = m->first + (m->reached - m->first) / unit * unit;
    for (uint64_t i = reached; s->mean && i < m->end; i++) s->mean[EC_BATCH_FIELDS * i] = EC_NOT_REACHED;
    if (m->first < s->handed) s->handed = m->first;
}

void ec_team_settle(member *m, ec_result result, bool complete, double seconds)
{
    ec_team *t = m->team;
    slot *s = m->slot;
    const double samples = (m->end - m->first) * ec_team_samples(t, s);
    m->is_busy = false;
    m->has_failed = result != EC_OK;
    if (m->has_failed) return; /* others take over the piece */
    t->rays += m->source->rays - m->rays;
    if (!complete) give_up(m);
    for (int i = 0; complete && i < EC_STAGE_COUNT; i++) s->invalid[i] += m->source->invalid[i] - m->invalid[i];
    m->slot = NULL;
    if (s->light == EC_LIGHT_ALONE) return;
    if (complete) m->samples += samples;
    m->seconds = fmax(seconds, 1e-6);
    if (m->pieces++) m->rate = samples / m->seconds; /* the first piece is slowed down by compilers */
}

uint32_t ec_team_done(const ec_team *t, const slot *s)
{
    uint32_t done = s->handed;
    for (uint32_t i = 0; i < t->count; i++)
        if (t->members[i].slot == s && t->members[i].first < done) done = t->members[i].first;
    return done;
}
