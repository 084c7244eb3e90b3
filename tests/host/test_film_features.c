/* tier: quick */
/* First-hit features of a film: by halves of the replicates, for batches, for pixels with samples of their own, and under a shadow. */
#include "support/films.h"
#include "support/test.h"

enum { W = 5, H = 3, P = W * H };

static const float colours[3 * P]; /* these make no difference */

static float feature(int batch, int i)
{
    const unsigned h = (unsigned)(batch * 7919 + i * 104729) * 2654435761u;
    return (float)(h >> 8) * 0x1p-24f * (float)(1 + i % 4);
}

/* Batches of 1 sample and, from the ninth on, of 2; the last one has only 1 of these. Added as they come, as in a file, and by rows. */
static void features_of_halves(void)
{
    for (uint32_t sets = 1; sets < 3; sets++) {
        enum { BATCHES = 11 };
        ec_film film, rows;
        ec_error err;
        float features[EC_FILM_FEATURES * P], half[EC_FILM_FEATURES * P];
        double sums[3][EC_FILM_FEATURES * P] = {{0}}, samples[3] = {0};
        CHECK_OK(ec_film_create(&film, W, H, 4, &err), err);
        ec_film_want_features(&film, sets, UINT32_MAX);
        for (int b = 0; b < BATCHES; b++) {
            const uint32_t cut = b == BATCHES - 1, own = ec_schedule_batch(4, (uint32_t)b).samples - cut;
            for (int h = 0; h < 3; h++) {
                if (h < 2 && h != b % 2) continue;
                for (int i = 0; i < EC_FILM_FEATURES * P; i++) features[i] = feature(b, i), sums[h][i] += own * features[i];
                samples[h] += own;
            }
            CHECK_OK(films_add_with(&film, (uint32_t)b, cut, colours, features, &err), err);
        }
        CHECK(samples[0] == 7 && samples[1] == 6 && samples[2] == 13 && ec_film_feature_samples(&film) == 13);
        ec_film read;
        CHECK_OK(ec_film_create(&read, W, H, 4, &err), err);
        ec_film_want_features(&read, sets, UINT32_MAX);
        for (uint32_t b = 0; b < BATCHES; b++) CHECK_OK(films_add_with(&read, b, 0, colours, features, &err), err);
        ec_film_set_cut(&read, 1);
        CHECK(!memcmp(read.parts->set_samples, film.parts->set_samples, sizeof film.parts->set_samples));
        ec_film_destroy(&read);
        CHECK_OK(ec_film_create_like(&rows, &film, H, &err), err);
        ec_film_copy_rows(&rows, 0, &film, 0, H);
        for (uint32_t h = 0; h < 3; h++) {
            const uint32_t of = sets == 2 ? h : EC_BOTH_HALVES;
            ec_film_features_of(&rows, h, 0, P, half);
            for (int i = 0; i < EC_FILM_FEATURES * P; i++) CHECK_NEAR(half[i], sums[of][i] / samples[of], 1e-5);
        }
        ec_film_destroy(&rows);
        ec_film_destroy(&film);
    }
}

/* Pixel 3 gets 1 more sample in each of 3 replicates, then 2 more: in one pass, in two, and in sums as if all pixels had these batches. */
static void features_go_on(void)
{
    enum { N = 3, ENTRIES = 2 * N };
    const uint32_t places[N] = {3, 3, 3};
    float features[ENTRIES * EC_FILM_FEATURES], batch[ENTRIES * EC_BATCH_FIELDS] = {0}, first[EC_FILM_FEATURES * P], out[EC_FILM_FEATURES * P];
    for (int i = 0; i < EC_FILM_FEATURES * P; i++) first[i] = 5;
    for (int i = 0; i < ENTRIES * EC_FILM_FEATURES; i++) features[i] = feature(1, i);
    for (uint32_t end = 3; end; end = end == 3 ? UINT32_MAX : 0)
        for (uint32_t sets = 1; sets < 3; sets++) {
            ec_film film;
            ec_error err;
            CHECK_OK(ec_film_create(&film, W, H, N, &err), err);
            ec_film_want_features(&film, sets, end);
            for (uint32_t r = 0; r < N; r++) CHECK_OK(films_add_with(&film, r, 0, colours, first, &err), err);
            CHECK_OK(ec_film_add_some(&film, batch, features, places, N, 1, &err), err);
            CHECK_OK(ec_film_add_some(&film, batch, features + N * EC_FILM_FEATURES, places, N, 2, &err), err);
            for (uint32_t half = 0; half < 3; half++) {
                ec_film_features_of(&film, half, 0, P, out);
                for (int i = 0; i < EC_FILM_FEATURES; i++) {
                    double sum = 0, samples = 0;
                    for (uint32_t r = 0; r < N; r++) {
                        if (sets == 2 && half < 2 && r % 2 != half) continue;
                        sum += 5 + features[EC_FILM_FEATURES * r + i] + 2 * (double)features[EC_FILM_FEATURES * (N + r) + i];
                        samples += 4;
                    }
                    CHECK_NEAR(out[3 * EC_FILM_FEATURES + i], end == 3 ? 5 : sum / samples, 1e-5);
                    CHECK(out[2 * EC_FILM_FEATURES + i] == 5);
                }
            }
            ec_film_destroy(&film);
        }
}

/* A shadow with a smaller alpha remains, in the picture only. */
static void shadow_is_alpha(void)
{
    ec_film film, rows;
    ec_error err;
    float features[EC_FILM_FEATURES * P], all[EC_FILM_FEATURES * P], half[EC_FILM_FEATURES * P];
    for (int i = 0; i < EC_FILM_FEATURES * P; i++) features[i] = i % EC_FILM_FEATURES == EC_FILM_ALPHA ? 0.5f : feature(0, i);
    CHECK_OK(ec_film_create(&film, W, H, 1, &err), err);
    ec_film_want_features(&film, 1, UINT32_MAX);
    CHECK_OK(films_add_with(&film, 0, 0, colours, features, &err), err);
    CHECK(ec_film_features_at(&film, 1) && !memcmp(ec_film_features_at(&film, 0), features, sizeof features));
    film.shadow = calloc(P, sizeof *film.shadow);
    film.shadow[1] = 0.25f, film.shadow[2] = 0.75f;
    CHECK_OK(ec_film_create_like(&rows, &film, H, &err), err);
    ec_film_copy_rows(&rows, 0, &film, 0, H);
    CHECK(!ec_film_features_at(&rows, 0));
    ec_film_features_of(&rows, EC_BOTH_HALVES, 0, P, all);
    ec_film_features_of(&rows, 0, 0, P, half);
    for (int i = 0; i < EC_FILM_FEATURES * P; i++) CHECK(half[i] == features[i] && all[i] == (i == 2 * EC_FILM_FEATURES + EC_FILM_ALPHA ? 0.75f : features[i]));
    ec_film_destroy(&rows);
    ec_film_destroy(&film);
}

int main(void)
{
    features_of_halves();
    features_go_on();
    shadow_is_alpha();
    TEST_END();
}
