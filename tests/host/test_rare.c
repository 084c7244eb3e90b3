/* tier: quick */
/* No bound while light may be missing: predictions of film/rare.h, and their effect on a film's error, on its pixels' flags and on a stored
 * job. */
#include "film/rare.h"

#include <math.h>
#include <stdlib.h>

#include "film/resolve.h"
#include "film/tail.h"
#include "support/films.h"
#include "support/test.h"

enum { WIDTH = 32, HEIGHT = 32, REPLICATES = 8 };

/* Half of the light is in the first tile and found by one of 2^20 samples; one of 10 finds the rest. */
static ec_rare two_kinds(void)
{
    ec_rare rare = {.count = 2, .width = WIDTH, .height = HEIGHT};
    rare.kinds[0] = (ec_rare_kind){.through = "glass", .light = "\"lamp\"", .chance = 0x1p-20, .luminance = 1, .gathered = 8, .share = {255}, .peak = EC_RARE_SHARES};
    rare.kinds[1] = (ec_rare_kind){.through = "steel", .light = "\"lamp\"", .chance = 0.1, .luminance = 1, .gathered = 1, .peak = 1};
    for (int i = 0; i < EC_RARE_SHARES; i++) rare.kinds[1].share[i] = 255;
    return rare;
}

static void test_kinds(void)
{
    const ec_rare rare = two_kinds();
    const ec_rare_kind *most;
    CHECK_NEAR(ec_rare_missing(&rare, 1, 3, 0, &most), 4 + 63, 1e-12); /* their means add up; peaks lie in different places */
    CHECK(most == &rare.kinds[0]);
    CHECK_NEAR(ec_rare_missing(&rare, 1e4, 3, 0, &most), 64, 1e-12); /* the second is met */
    CHECK(ec_rare_missing(&rare, EC_RARE_MET * 0x1p20, 3, 0, &most) == 0 && !most);
    CHECK(ec_rare_missing(NULL, 1, 3, 0, &most) == 0 && !most);
    CHECK_NEAR(ec_rare_missing_at(&rare, 64, 3, 0, 0, 0), EC_RARE_SHARES, 1e-9); /* all of it in one of so many tiles */
    CHECK(ec_rare_missing_at(&rare, 64, 3, 0, 2, 0) == 0);
    ec_rare clamped = rare;
    clamped.kinds[0].clamped = 0.5; /* half of its light, limited to 4 a sample */
    CHECK_NEAR(ec_rare_missing(&clamped, 1e4, 3, 4, &most), 64 * pow(0.5 + 4 * 0x1p-20, 2), 1e-12);
    clamped.kinds[0].is_relative = true;
    CHECK_NEAR(ec_rare_missing(&clamped, 1e4, 3, 0, &most), 64 * 9, 1e-12); /* three times the picture's mean */
    ec_rare strip = rare;
    strip.row = 2;
    CHECK(ec_rare_missing_at(&strip, 64, 3, 0, 0, 0) == 0); /* another row of tiles */
}

/* Grey pixels with a little noise. */
static ec_film make_film(void)
{
    ec_film film;
    ec_error err = {0};
    float *batch = calloc((size_t)WIDTH * HEIGHT * EC_BATCH_FIELDS, sizeof *batch);
    if (!batch || ec_film_create(&film, WIDTH, HEIGHT, REPLICATES, &err) != EC_OK) exit(1);
    uint32_t state = 1;
    for (uint32_t r = 0; r < REPLICATES; r++) {
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            state = state * 1664525u + 1013904223u;
            float *p = batch + EC_BATCH_FIELDS * i, value = 1 + 0.1f * ((float)(state >> 8) / 16777216.0f - 0.5f);
            p[EC_BATCH_R] = p[EC_BATCH_G] = p[EC_BATCH_B] = p[EC_BATCH_LARGEST] = value;
            p[EC_BATCH_SQUARES] = p[EC_BATCH_FOURTHS] = 1;
        }
        if (ec_film_add(&film, r, batch, &err) != EC_OK) exit(1);
    }
    free(batch);
    return film;
}

static uint64_t count_heavy(const ec_film *film, float *heavy)
{
    ec_pixel *room = malloc(ec_resolve_room(WIDTH, HEIGHT) * sizeof *room);
    const ec_planes planes = {.intervals = {.heavy = heavy}};
    const uint64_t count = ec_film_resolve_rows(film, 0, HEIGHT, &planes, room);
    free(room);
    return count;
}

static void test_film(void)
{
    ec_error err = {0};
    ec_film film = make_film();
    float before[WIDTH * HEIGHT], heavy[WIDTH * HEIGHT];
    uint64_t added = 0;
    ec_rare rare = two_kinds();
    const ec_film_error plain = ec_film_estimate_error(&film);
    CHECK(!plain.is_open && isfinite(plain.error_bound) && plain.missing_light == 0);
    const uint64_t count = count_heavy(&film, before); /* since samples are few */

    CHECK(ec_film_set_rare(&film, &rare, &err) == EC_OK);
    const ec_film_error open = ec_film_estimate_error(&film);
    CHECK(open.is_open && isinf(open.error_bound) && open.error == plain.error && open.bound_if_met == plain.error_bound);
    CHECK_NEAR(open.missing_light, 8 / plain.mean_luminance, 1e-9);
    CHECK_NEAR(open.missing_light_samples, EC_RARE_MET * 0x1p20 / (WIDTH * HEIGHT), 1e-6);
    CHECK(!strcmp(open.through, "glass") && !strcmp(open.light, "\"lamp\""));
    const uint64_t with = count_heavy(&film, heavy); /* now the whole first tile, 2 x 2 pixels */
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const bool is_lacking = i % WIDTH < 2 && i / WIDTH < 2;
        CHECK(heavy[i] == (is_lacking ? 1 : before[i]));
        added += heavy[i] != before[i];
    }
    CHECK(added > 0 && with == count + added);

    rare.kinds[0].luminance = 1e-5; /* negligible beside the noise */
    CHECK(ec_film_set_rare(&film, &rare, &err) == EC_OK);
    const ec_film_error weak = ec_film_estimate_error(&film);
    CHECK(!weak.is_open && count_heavy(&film, heavy) == count);
    CHECK_NEAR(weak.error_bound, hypot(plain.error_bound, EC_RARE_DOUBT * weak.missing_light), 1e-12); /* wider because of it */
    ec_film_destroy(&film);
}

/* A sample that found the light by chance makes the picture brighter, so the missing light seems small beside it. */
static void test_lucky_sample(void)
{
    ec_error err = {0};
    ec_film film = make_film();
    ec_rare rare = {.count = 1, .width = WIDTH, .height = HEIGHT};
    for (int c = 0; c < 3; c++) film.parts[0].sums.mean[c] += 8e4f; /* the first replicate of a pixel: ten times the picture's light */
    film.parts[0].sums.tail[0] += 8e4f;
    rare.kinds[0] = (ec_rare_kind){.through = "glass", .light = "\"lamp\"", .chance = 0x1p-20, .luminance = 0.2, .gathered = 1};
    CHECK(ec_film_set_rare(&film, &rare, &err) == EC_OK);
    const ec_film_error lucky = ec_film_estimate_error(&film);
    CHECK(lucky.missing_light < EC_RARE_LEAST && lucky.missing_light < lucky.bound_if_met - lucky.error && lucky.tail_share > 0.75);
    CHECK(lucky.is_open);
    rare.kinds[0].luminance = 0.01; /* almost nothing of the picture without that sample */
    CHECK(ec_film_set_rare(&film, &rare, &err) == EC_OK);
    CHECK(!ec_film_estimate_error(&film).is_open);
    ec_film_destroy(&film);
}

static void test_tail(void)
{
    ec_tail a = {0}, b = {0}, all = {0};
    for (int i = 0; i < 40; i++) {
        const double value = (i * 7) % 40;
        ec_tail_add(i % 2 ? &a : &b, value);
        ec_tail_add(&all, value);
    }
    ec_tail_join(&a, &b);
    CHECK(a.count == EC_TAIL_FEW && !memcmp(a.largest, all.largest, sizeof a.largest));
    for (int i = 0; i < EC_TAIL_FEW; i++) CHECK(all.largest[i] == 39 - i);
}

int main(void)
{
    test_kinds();
    test_film();
    test_lucky_sample();
    test_tail();
    TEST_END();
}
