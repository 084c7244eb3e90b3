/* Builds the table of path guiding. Boxes are halved until few photons are in each; in each box squares of the directions are quartered until each
 * has little of its flux. Then flux is counted anew, spread around where each photon lies (as Mueller 2019 does it, with a long tail), so that no
 * direction that light may come from is left out for want of a photon. */
#include "device/guide.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "shared/guide.h"

#define PI 3.14159265358979323846
#define BOX_PHOTONS 500    /* boxes with more are halved */
#define BOX_LEAST 64       /* boxes with fewer guide nothing */
#define BOX_DEPTH 24
#define SQUARE_DEPTH 11
#define SQUARE_SHARE 0.01  /* of its box's flux, and … */
#define SQUARE_PHOTONS 8   /* … photons in a square that is quartered */
#define CONCENTRATED 16.0 /* mean density of light, over that of light from all around: boxes with less need no guide */
#define GUIDED_SHARE 0.5f  /* share of directions that are guided */

#define LAST_UNIT 0x1.fffffep-1f

/* Each photon is counted once for each of these, moved by up to half as many sizes of its box and of its square. */
static const float spreads[] = {1, 1, 1, 1, 1, 2, 4, 8};

typedef struct table {
    float *words;
    size_t count, room;
} table;

/* A photon in its box. */
typedef struct photon {
    float p[3], size, x, y, flux, spare;
} photon;
_Static_assert(sizeof(photon) == sizeof(ec_photon), "one takes the place of the other");

/* Adds words, zeroed, to the table; *at: the first of them. */
static ec_result add(table *t, size_t words, size_t *at, ec_error *err)
{
    if (t->count + words > t->room) {
        const size_t room = t->room ? 2 * t->room : 4096;
        float *more = realloc(t->words, room * sizeof *more);
        if (!more) return ec_fail(err, "out of memory for the table of --guiding");
        t->words = more;
        t->room = room;
    }
    *at = t->count;
    memset(t->words + *at, 0, words * sizeof *t->words);
    t->count += words;
    return EC_OK;
}

static void set_word(float *at, size_t value)
{
    const uint32_t word = (uint32_t)value;
    memcpy(at, &word, sizeof word);
}

static uint32_t get_word(const float *at)
{
    uint32_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

/* Moves those first whose word of that number is less than `than`; returns how many they are. */
static size_t part(ec_photon *list, size_t count, size_t word, float than)
{
    size_t less = 0;
    for (size_t i = 0; i < count; i++) {
        float value;
        memcpy(&value, (const char *)&list[i] + word * sizeof value, sizeof value);
        if (value >= than) continue;
        const ec_photon one = list[i];
        list[i] = list[less];
        list[less++] = one;
    }
    return less;
}

static double flux_of(const ec_photon *list, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += list[i].flux;
    return sum;
}

enum { WORD_X = offsetof(photon, x) / sizeof(float), WORD_Y = offsetof(photon, y) / sizeof(float) };

/* Adds a square from x, y on, and its quarters, for the photons in it. */
static ec_result add_square(table *t, ec_photon *list, size_t count, float x, float y, float size, double least, int depth, size_t *at, ec_error *err)
{
    const float half = 0.5f * size;
    size_t first[5] = {0, 0, 0, 0, count};
    EC_TRY(add(t, EC_GUIDE_SQUARE_WORDS, at, err));
    first[2] = part(list, count, WORD_Y, y + half);
    first[1] = part(list, first[2], WORD_X, x + half);
    first[3] = first[2] + part(list + first[2], count - first[2], WORD_X, x + half);
    for (int k = 0; k < 4; k++) {
        ec_photon *own = list + first[k];
        const size_t n = first[k + 1] - first[k];
        size_t quarter = 0;
        if (depth + 1 == SQUARE_DEPTH || n < SQUARE_PHOTONS || flux_of(own, n) < least) continue;
        EC_TRY(add_square(t, own, n, k & 1 ? x + half : x, k & 2 ? y + half : y, half, least, depth + 1, &quarter, err));
        set_word(&t->words[*at + 2 * k + 1], quarter);
    }
    return EC_OK;
}

/* Sets a direction's place in the square. */
static void find_place(const float d[3], float *x, float *y)
{
    const double turn = atan2((double)d[1], (double)d[0]) / (2 * PI);
    *x = fminf((float)fmax(0.5 * d[2] + 0.5, 0), LAST_UNIT);
    *y = fminf((float)(turn < 0 ? turn + 1 : turn), LAST_UNIT);
}

/* Turns a photon into one in its box, of this size. */
static void place(ec_photon *one, float size)
{
    photon in = {.size = size, .flux = one->flux};
    memcpy(in.p, one->p, sizeof in.p);
    find_place(one->d, &in.x, &in.y);
    memcpy(one, &in, sizeof in);
}

static ec_result add_leaf(table *t, size_t box, ec_photon *list, size_t count, float size, ec_error *err)
{
    size_t root = 0;
    for (size_t i = 0; i < count; i++) place(&list[i], size);
    if (count >= BOX_LEAST) {
        EC_TRY(add_square(t, list, count, 0, 0, 1, SQUARE_SHARE * flux_of(list, count), 0, &root, err));
        t->words[box] = GUIDED_SHARE;
    }
    set_word(&t->words[box + 1], 4 * root + EC_GUIDE_LEAF);
    return EC_OK;
}

/* Divides a box, or makes it a leaf. box: its first word. */
static ec_result fill_box(table *t, size_t box, ec_photon *list, size_t count, int depth, ec_error *err)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int axis = 0;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) low[k] = fminf(low[k], list[i].p[k]), high[k] = fmaxf(high[k], list[i].p[k]);
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const float middle = 0.5f * low[axis] + 0.5f * high[axis];
    if (count <= BOX_PHOTONS || depth == BOX_DEPTH || !(low[axis] < middle)) return add_leaf(t, box, list, count, count ? high[axis] - low[axis] : 0, err);
    const size_t below = part(list, count, (size_t)axis, middle);
    size_t halves = 0;
    EC_TRY(add(t, 2 * EC_GUIDE_BOX_WORDS, &halves, err));
    t->words[box] = middle;
    set_word(&t->words[box + 1], 4 * (halves / EC_GUIDE_BOX_WORDS) + (size_t)axis);
    EC_TRY(fill_box(t, halves, list, below, depth + 1, err));
    return fill_box(t, halves + EC_GUIDE_BOX_WORDS, list + below, count - below, depth + 1, err);
}

/* Returns the word at which p's box begins; *root: the root of its quadtree, 0 if it has none. */
static size_t box_at(const float *words, const float p[3], uint32_t *root)
{
    for (size_t box = 0;;) {
        const uint32_t link = get_word(&words[box + 1]), axis = link & 3;
        *root = link >> 2;
        if (axis == EC_GUIDE_LEAF) return box;
        box = EC_GUIDE_BOX_WORDS * (*root + (size_t)(p[axis] >= words[box]));
    }
}

/* Returns the quarter in which *x, *y lie, and turns them into its own coordinates. */
static int quarter_of(float *x, float *y)
{
    const int right = *x >= 0.5f, up = *y >= 0.5f;
    *x = 2 * *x - (float)right;
    *y = 2 * *y - (float)up;
    return right + 2 * up;
}

static float size_at(const table *t, uint32_t at, float x, float y)
{
    float size = 1;
    for (; at; size *= 0.5f) at = get_word(&t->words[at + 2 * (size_t)quarter_of(&x, &y) + 1]);
    return size;
}

/* Returns a random number in [-0.5, 0.5). */
static float jitter(uint64_t *state)
{
    *state += EC_RANDOM_STEP;
    return (float)((double)(ec_random_mix(*state) >> 40) * 0x1p-24 - 0.5);
}

/* Spreads a photon's flux. sums: of each word of the table that is a share. */
static void spread(const table *t, double *sums, const photon *one, float factor, uint64_t *state)
{
    float p[3];
    for (int k = 0; k < 3; k++) p[k] = one->p[k] + factor * one->size * jitter(state);
    uint32_t at;
    box_at(t->words, p, &at);
    const float size = factor * size_at(t, at, one->x, one->y);
    float x = one->x + size * jitter(state), y = one->y + size * jitter(state);
    x = fminf(fmaxf(x < 0 ? -x : x >= 1 ? 2 - x : x, 0), LAST_UNIT); /* reflected at the poles, and once around */
    y = fminf(y - floorf(y), LAST_UNIT);
    while (at) {
        const size_t share = at + 2 * (size_t)quarter_of(&x, &y);
        sums[share] += one->flux;
        at = get_word(&t->words[share + 1]);
    }
}

/* Sets the shares of a square and of the squares in it. Returns the mean density where light comes from, over the square's own mean: 1 where it comes
 * evenly. */
static double settle_square(table *t, const double *sums, size_t at)
{
    double sum = 0, mean = 0;
    for (size_t share = at; share < at + EC_GUIDE_SQUARE_WORDS; share += 2) sum += sums[share];
    for (size_t share = at; share < at + EC_GUIDE_SQUARE_WORDS; share += 2) {
        const uint32_t quarter = get_word(&t->words[share + 1]);
        const double own = sum > 0 ? sums[share] / sum : 0.25;
        if (sum > 0) t->words[share] = (float)own;
        mean += 4 * own * own * (quarter ? settle_square(t, sums, quarter) : 1);
    }
    return mean;
}

static void settle_box(table *t, const double *sums, size_t box)
{
    const uint32_t link = get_word(&t->words[box + 1]), at = link >> 2;
    if ((link & 3) != EC_GUIDE_LEAF) {
        settle_box(t, sums, at * EC_GUIDE_BOX_WORDS);
        settle_box(t, sums, (at + 1) * EC_GUIDE_BOX_WORDS);
    } else if (at && settle_square(t, sums, at) < CONCENTRATED) t->words[box] = 0;
}

static ec_result fill_shares(table *t, const ec_photon *list, size_t count, ec_error *err)
{
    uint64_t state = 1;
    double *sums = calloc(t->count, sizeof *sums);
    if (!sums) return ec_fail(err, "out of memory for the table of --guiding");
    for (size_t i = 0; i < count; i++) {
        photon one;
        memcpy(&one, &list[i], sizeof one);
        for (size_t k = 0; k < sizeof spreads / sizeof *spreads; k++) spread(t, sums, &one, spreads[k], &state);
    }
    settle_box(t, sums, 0);
    free(sums);
    return EC_OK;
}

ec_result ec_guide_build(ec_photon *photons, size_t count, float **words, size_t *word_count, ec_error *err)
{
    table t = {0};
    size_t root = 0;
    *words = NULL;
    *word_count = 0;
    if (count < BOX_LEAST) return EC_OK;
    ec_result result = add(&t, 2 * EC_GUIDE_BOX_WORDS, &root, err);
    if (result == EC_OK) result = fill_box(&t, root, photons, count, 0, err);
    if (result == EC_OK) result = fill_shares(&t, photons, count, err);
    if (result != EC_OK) {
        free(t.words);
        return result;
    }
    *words = t.words;
    *word_count = t.count;
    return EC_OK;
}

double ec_guide_pdf(const float *words, const float p[3], const float d[3], double *share)
{
    double pdf = 0.25 / PI;
    uint32_t at;
    float x, y;
    *share = words ? (double)words[box_at(words, p, &at)] : 0;
    if (!(*share > 0)) return 0;
    for (find_place(d, &x, &y); at;) {
        const size_t quarter = at + 2 * (size_t)quarter_of(&x, &y);
        pdf *= 4 * (double)words[quarter];
        at = get_word(&words[quarter + 1]);
    }
    return pdf;
}
