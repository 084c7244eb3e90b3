/* Runs a team of sources under ThreadSanitizer (test_races.py). Sources of different speed work on batches; one fails on the way and one at
 * once. Every position of the result is checked, in order, with and without pixel lists, and with blocks of batches. With an argument the
 * sources make a race of their own, which must be found. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../support/films.h"
#include "device/fold.h"
#include "render/team.h"

enum { WIDTH = 40, HEIGHT = 37, PIXELS = WIDTH * HEIGHT, MEMBERS = 5, BATCHES = 60, REPLICATES = EC_REPLICATES, FIELDS = EC_BATCH_FIELDS };

static bool races;
static uint64_t raced;

typedef struct fake {
    ec_batch_source base;
    uint32_t index, taken, pause; /* microseconds every 64 pixels */
    bool is_quick, has_met;
} fake;

/* A team chooses blocks once it knows the pace of all members, so that each has to get work early. Those that open meet at their first. */
static pthread_barrier_t met;

static float value(uint32_t batch, uint32_t pixel) { return (float)(batch * 4096 + pixel); }

/* Fills a pixel's fields of a batch with value(), as one sample would. */
static void fill(float *batch, uint32_t index, uint32_t pixel)
{
    for (uint32_t k = 0; k < FIELDS; k++) batch[k] = k <= EC_BATCH_LARGEST ? value(index, pixel) : 1;
}

/* Fills the pixel's features. */
static void fill_features(float *features, uint32_t index, uint32_t pixel)
{
    for (uint32_t k = 0; k < EC_AOV_FIELDS; k++) features[k] = value(index, pixel) + (float)k;
}

static bool has_features(const float *features, uint32_t index, uint32_t pixel)
{
    float expected[EC_AOV_FIELDS];
    fill_features(expected, index, pixel);
    return !memcmp(features, expected, sizeof expected);
}

static bool is_filled(const float *batch, uint32_t index, uint32_t pixel)
{
    float expected[FIELDS];
    fill(expected, index, pixel);
    return !memcmp(batch, expected, sizeof expected);
}

static uint32_t pixel_at(const ec_batch_order *order, uint32_t i) { return order->list ? order->list[EC_LIST_WORDS * i] : i; }

static ec_result take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    fake *f = (fake *)source;
    float *into = order->into;
    *complete = true;
    const ec_fold_parts parts = {.batches = 1, .take = take, .want_room = true};
    if (order->batches > 1) return ec_fold_block(source, order, REPLICATES, &parts, &source->invalid[1], complete, err);
    if (f->is_quick && !f->has_met) f->has_met = true, pthread_barrier_wait(&met);
    for (uint32_t i = order->done; i < order->count; i++) into[FIELDS * (i - order->done)] = 777; /* an older batch's values */
    if (f->index == 1 && f->taken++ == (f->is_quick ? 200 : 7)) return ec_fail(err, "it is over");
    for (uint32_t i = order->done; i < order->count && *complete; i++) {
        fill(into + FIELDS * (i - order->done), order->index, pixel_at(order, i));
        if (order->features_into) fill_features(order->features_into + EC_AOV_FIELDS * (i - order->done), order->index, pixel_at(order, i));
        if (f->pause && i % 64 == 0) usleep(f->pause);
        if (i % 64 == 0) *complete = order->go_on(order->user, i + 1) || i + 1 == order->count;
    }
    usleep(f->is_quick ? 1 : f->index == 2 ? 4000 : 300);
    if (races) raced++;
    source->rays += order->count - order->done;
    source->invalid[0] += 2;
    return EC_OK;
}

static void close_fake(ec_batch_source *source) { (void)source; }

static ec_result open_fake(void *user, ec_batch_source **source, ec_error *err)
{
    fake *f = user;
    f->base.take = take;
    f->base.close = close_fake;
    f->base.least = f->is_quick ? 1 : 100; /* not even a member that other programs slow down keeps a team from blocks */
    *source = &f->base;
    return f->index == 3 ? ec_fail(err, "it does not open") : EC_OK;
}

static bool go_on(void *user, uint32_t done)
{
    *(uint32_t *)user = done;
    return true;
}

/* Asks to stop while the batch has gaps. */
static bool stop_early(void *user, uint32_t done)
{
    (void)done;
    return ++*(uint32_t *)user < 3;
}

/* Checks an interrupted first batch: wrong pixels are marked. */
static int check_marked(const ec_team_candidate *candidates)
{
    uint32_t asked = 0, reached = 0, wrong = 0;
    ec_team *team;
    ec_error err = {0};
    bool complete;
    if (ec_team_open(candidates, MEMBERS, WIDTH, HEIGHT, REPLICATES, NULL, &team, &err) != EC_OK) return 1;
    ec_batch_source *source = ec_team_source(team);
    const ec_batch_order order = {.index = 0, .end = 9, .count = PIXELS, .feature_sets = 1, .go_on = stop_early, .user = &asked};
    if (source->take(source, &order, &complete, &err) != EC_OK || complete) return 1;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const bool is_right = is_filled(source->mean + FIELDS * i, 0, i);
        reached += is_right;
        wrong += is_right ? !has_features(source->features + EC_AOV_FIELDS * i, 0, i) : source->mean[FIELDS * i] != EC_NOT_REACHED;
    }
    ec_team_free(team);
    return wrong || reached == PIXELS;
}

static uint32_t whole(const void *user, uint32_t index)
{
    (void)user, (void)index;
    return UINT32_MAX;
}

enum { MOST = EC_BLOCK_MOST + 3 * EC_FILM_FIRST + 40 };

/* The number of batches in an order, as a rank gets it. */
static uint32_t ordered(uint32_t b)
{
    if (b % EC_BLOCK_MOST == 0 && b + EC_BLOCK_MOST <= MOST) return EC_BLOCK_MOST;
    return b % EC_FILM_FIRST == 0 && b + EC_FILM_FIRST <= MOST ? EC_FILM_FIRST : 1;
}

/* Checks that a film of a team's blocks has the bits of one made batch by batch, though one member fails in the middle. is_told: the order
 * gives the blocks, and covers the rows from the second row of tiles on; otherwise the team chooses. */
static int check_blocks(ec_team_candidate *candidates, bool is_told)
{
    static float batch[FIELDS * PIXELS], features[EC_AOV_FIELDS * PIXELS];
    const uint32_t rows = is_told ? HEIGHT - EC_TILE_ROWS : HEIGHT, from = PIXELS - WIDTH * rows;
    uint32_t done = 0, blocks = 0, took;
    ec_team *team;
    ec_film alone, film;
    ec_error err = {0};
    bool complete;
    for (uint32_t i = 0; i < MEMBERS; i++) candidates[i].processes = 1;
    if (ec_team_open(candidates, MEMBERS, WIDTH, HEIGHT, REPLICATES, NULL, &team, &err) != EC_OK || ec_film_create(&film, WIDTH, rows, REPLICATES, &err) != EC_OK ||
        ec_film_create(&alone, WIDTH, rows, REPLICATES, &err) != EC_OK)
        return 1;
    ec_film_want_features(&film, 2, UINT32_MAX);
    ec_film_want_features(&alone, 2, UINT32_MAX);
    ec_batch_source *source = ec_team_source(team);
    for (uint32_t b = 0; b < MOST; b += took) {
        const uint32_t told = is_told ? ordered(b) : 0;
        const ec_batch_order order = {.index = b, .batches = told, .end = told ? b + told : MOST, .done = from, .count = PIXELS, .feature_sets = 2, .whole = whole, .patience = 100,
                                      .until = 1e300, .go_on = go_on, .user = &done};
        if (source->take(source, &order, &complete, &err) != EC_OK || !complete) return 1;
        took = source->batches;
        ec_film_part part = {.first = b, .count = took, .sums = source->sums};
        if (took > 1) source->sums = (ec_sums){0}, blocks++;
        const ec_film_batch one = {.index = b, .values = source->mean + FIELDS * from, .features = source->features + EC_AOV_FIELDS * from};
        if ((took > 1 ? ec_film_insert(&film, &part, &err) : ec_film_take(&film, &one, &err)) != EC_OK) return 1;
    }
    for (uint32_t b = 0; b < MOST; b++) {
        for (uint32_t i = 0; i < PIXELS - from; i++) fill(batch + FIELDS * i, b, from + i), fill_features(features + EC_AOV_FIELDS * i, b, from + i);
        if (ec_film_take(&alone, &(ec_film_batch){.index = b, .values = batch, .features = features}, &err) != EC_OK) return 1;
    }
    ec_team_free(team);
    const bool same = films_same_bits(&film, &alone) && films_same_features(&film, &alone) && film.batch_count == MOST;
    ec_film_destroy(&film);
    ec_film_destroy(&alone);
    printf("%u blocks, %s\n", blocks, same ? "the same bits" : "other bits");
    return !same || blocks < 3;
}

static void count_warning(void *user, ec_severity severity, const char *text)
{
    (void)severity;
    fprintf(stderr, "%s\n", text);
    ++*(int *)user;
}

static int check(const ec_batch_order *order, const ec_batch_source *source)
{
    for (uint32_t i = 0; i < order->count; i++) {
        if (!is_filled(source->mean + FIELDS * i, order->index, pixel_at(order, i))) return 1;
        if (order->feature_sets && !has_features(source->features + EC_AOV_FIELDS * i, order->index, pixel_at(order, i))) return 1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    (void)argv;
    races = argc > 1;
    static fake fakes[MEMBERS];
    static uint32_t list[EC_LIST_WORDS * PIXELS];
    ec_team_candidate candidates[MEMBERS];
    ec_team *team;
    ec_error err = {0};
    int wrong = 0, warnings = 0;
    if (pthread_barrier_init(&met, NULL, MEMBERS - 1)) return 2;
    uint32_t done = 0;
    double due = 0;
    const ec_log log = {count_warning, &warnings};
    for (uint32_t i = 0; i < MEMBERS; i++) {
        fakes[i].index = i;
        candidates[i] = (ec_team_candidate){.name = "a fake", .open = open_fake, .user = &fakes[i]};
    }
    for (uint32_t i = 0; i < PIXELS; i++) list[EC_LIST_WORDS * i] = PIXELS - 1 - i;
    if (ec_team_open(candidates, MEMBERS, WIDTH, HEIGHT, REPLICATES, &log, &team, &err) != EC_OK) return 2;
    ec_batch_source *source = ec_team_source(team);
    for (uint32_t b = 3; b < BATCHES; b++) {
        const bool is_pass = b % 20 == 0;
        const uint32_t samples = ec_schedule_batch(REPLICATES, b).samples, cut = b == BATCHES - 1 ? samples / 2 : 0;
        const uint32_t next_pass = b / 20 * 20 + 20, end = next_pass < BATCHES || cut ? next_pass : BATCHES - 1; /* no batch follows a cut one */
        const ec_batch_order order = {.index = b, .end = end, .list = is_pass ? list : NULL, .samples = is_pass ? 3 : 0,
                                      .cut = cut, .count = is_pass ? PIXELS - 100 : PIXELS, .feature_sets = b / 20 % 2, .go_on = go_on, .user = &done};
        bool complete;
        if (source->take(source, &order, &complete, &err) != EC_OK || !complete || done != order.count) return 3;
        wrong += check(&order, source);
        due += order.count * (is_pass ? 3.0 : samples - (double)cut);
    }
    double shares = 0;
    source->close(source);
    for (uint32_t i = 0; i < MEMBERS; i++) {
        bool has_failed;
        shares += ec_team_share(team, i, &has_failed);
        wrong += has_failed != (i == 1 || i == 3);
    }
    ec_team_free(team);
    printf("%d batches of %d sources, %d wrong, %d warnings, %s\n", BATCHES - 3, MEMBERS, wrong, warnings,
           shares == due ? "all samples once" : "not all samples once");
    for (uint32_t i = 0; i < MEMBERS; i++) fakes[i].taken = 0, fakes[i].is_quick = true;
    wrong += check_blocks(candidates, false);
    fakes[1].taken = 0;
    wrong += check_blocks(candidates, true);
    for (uint32_t i = 0; i < MEMBERS; i++) fakes[i].pause = 20000, fakes[i].is_quick = false;
    const int unmarked = check_marked(candidates);
    if (unmarked) printf("not marked\n");
    return wrong || unmarked;
}
