/* tier: quick */
/* The comparison of pictures itself: it must nearly always pass equal pictures, and find the errors that it is for. */
#include "film/resolve.h"
#include "support/films.h"
#include "support/random.h"
#include "support/test.h"
#include "support/ztest.h"

enum { W = 64, H = 48, VALUES = 3 * W * H };

static test_random state = {1};
static double normal(void) { return test_normal(&state); }

static double truth(int i) { return 0.1 + (double)(i % 97) / 50; }

/* A picture of so many replicates with normal noise; left: factor of its left half. */
static ztest_picture render(int replicates, double noise, double left)
{
    ec_film film;
    ec_error err;
    ztest_picture picture = {W, H, malloc(VALUES * sizeof(float)), malloc(VALUES * sizeof(float)), replicates - 1};
    CHECK_OK(ec_film_create(&film, W, H, (uint32_t)replicates, &err), err);
    for (int b = 0; b < replicates; b++) {
        static float batch[VALUES];
        for (int i = 0; i < VALUES; i++)
            batch[i] = (float)(truth(i) * (i / 3 % W < W / 2 ? left : 1) * (1 + noise * normal()));
        CHECK_OK(films_add(&film, (uint32_t)b, batch, &err), err);
    }
    ec_film_resolve(&film, picture.rgb, picture.se);
    ec_film_destroy(&film);
    return picture;
}

static ztest_result compare(ztest_picture image, ztest_picture reference, const char *map)
{
    ztest_result result = ztest_compare(&image, &reference, NULL, map);
    ztest_free(&image);
    ztest_free(&reference);
    return result;
}

static void equal_pictures_pass(void)
{
    const int replicates[] = {2, 4, 8};
    for (int k = 0; k < 3; k++) {
        uint64_t outliers = 0, values = 0;
        for (int i = 0; i < 20; i++) {
            ztest_result r = compare(render(replicates[k], 0.5, 1), render(16, 0.5, 1), NULL);
            CHECK_MSG(r.pass, "%s", r.text);
            outliers += r.outliers;
            values += r.values;
        }
        /* 20 tests at 1 % each should find 0.2 outliers; a z-test instead of the t-test finds thousands. */
        CHECK_MSG(outliers <= 3, "%llu of %llu with %d replicates", (unsigned long long)outliers,
                  (unsigned long long)values, replicates[k]);
    }
}

static void a_small_bias_is_seen_in_the_mean(void)
{
    ztest_result r = compare(render(16, 0.5, 1.06), render(16, 0.5, 1), NULL);
    CHECK_MSG(!r.pass && r.outlier_share < 0.0025 && fabs(r.mean_z[0]) > 4, "%s", r.text);
    CHECK_NEAR(r.mean_difference[1] / r.reference_mean[1], 0.03, 0.01);
}

static void wrong_pixels_are_found_and_mapped(void)
{
    const char *map = ECLAT_TEST_OUT "/ztest-map.exr";
    remove(map);
    ztest_picture image = render(16, 0.1, 1), reference = render(16, 0.1, 1);
    for (int p = 0; p < W * H; p += 100) image.rgb[3 * p + 1] *= p % 200 ? 2.5f : 0.1f; /* 0.33 % of values */
    image.rgb[3 * (7 * W + 11) + 2] = 100;
    float odd = image.rgb[100 * 3 + 1];
    ztest_result r = compare(image, reference, map);
    CHECK_MSG(!r.pass && r.outliers >= 31 && r.outliers <= 33, "%s", r.text);
    CHECK_MSG(r.worst_x == 11 && r.worst_y == 7 && r.worst_channel == 2 && r.worst_z > 50, "%s", r.text);
    ec_exr exr;
    ec_error err;
    CHECK_OK(ec_exr_read(map, &exr, &err), err);
    CHECK(exr.width == W && exr.height == H && exr.channel_count == 12);
    CHECK(ec_exr_plane(&exr, "G") && ec_exr_plane(&exr, "G")[100] == odd);
    CHECK(ec_exr_plane(&exr, "z.B") && ec_exr_plane(&exr, "z.B")[7 * W + 11] == (float)r.worst_z);
    CHECK(ec_exr_plane(&exr, "difference.G") && ec_exr_plane(&exr, "reference.G"));
    ec_exr_free(&exr);
    remove(map);
}

static void exact_pixels_may_differ_by_rounding(void)
{
    ztest_picture image = render(4, 0, 1), reference = render(4, 0, 1);
    for (int i = 0; i < VALUES; i++) {
        image.rgb[i] = i % 5 ? nextafterf(image.rgb[i], 9) : 0;
        if (i % 5 == 0) reference.rgb[i] = 0; /* black against black: no variance, no mean, no NaN */
    }
    ztest_result r = compare(image, reference, NULL);
    CHECK_MSG(r.pass && r.outliers == 0 && isfinite(r.worst_z), "%s", r.text);
}

static void broken_values_and_sizes_fail(void)
{
    ztest_picture image = render(4, 0.5, 1);
    image.rgb[5] = NAN;
    ztest_result r = compare(image, render(4, 0.5, 1), NULL);
    CHECK_MSG(!r.pass && r.outliers == 1, "%s", r.text);
    image = render(4, 0.5, 1);
    image.height--;
    r = compare(image, render(4, 0.5, 1), NULL);
    CHECK_MSG(!r.pass && strstr(r.text, "64 x 47"), "%s", r.text);
}

/* A light that few samples find: an image that missed it has standard error 0 there, but is not another picture. */
static void the_reference_may_lend_its_variance(void)
{
    ztest_picture image = render(4, 0, 1), reference = render(16, 0, 1);
    for (int p = 0; p < W * H; p += 50)
        for (int c = 0; c < 3; c++) {
            reference.rgb[3 * p + c] += 0.1f;
            reference.se[3 * p + c] = 0.1f;
        }
    reference.dof = INFINITY;
    ztest_options lend = {.variance_ratio = 4};
    ztest_result alone = ztest_compare(&image, &reference, NULL, NULL);
    ztest_result lent = ztest_compare(&image, &reference, &lend, NULL);
    CHECK_MSG(lent.pass && lent.mean_se[0] > 2 * alone.mean_se[0], "%s", lent.text);
    ztest_free(&image);
    ztest_free(&reference);
}

static void a_picture_loads_with_its_standard_error(void)
{
    const char *path = ECLAT_SHARED "/reference/cornell-box/reference.exr";
    FILE *file = fopen(path, "rb");
    if (!file) return;
    fclose(file);
    ztest_picture picture;
    ec_error err;
    CHECK_OK(ztest_load(path, 15, &picture, &err), err);
    double sum[2] = {0};
    for (uint32_t i = 0; i < 3 * picture.width * picture.height; i++) {
        sum[0] += picture.rgb[i];
        sum[1] += picture.se[i];
    }
    CHECK_MSG(sum[0] > 0 && sum[1] > 0 && sum[1] < 0.05 * sum[0], "%g %g", sum[0], sum[1]);
    ztest_result r = ztest_compare(&picture, &picture, NULL, NULL);
    CHECK_MSG(r.pass && r.outliers == 0, "%s", r.text);
    ztest_free(&picture);
}

int main(void)
{
    equal_pictures_pass();
    a_small_bias_is_seen_in_the_mean();
    wrong_pixels_are_found_and_mapped();
    exact_pixels_may_differ_by_rounding();
    broken_values_and_sizes_fail();
    the_reference_may_lend_its_variance();
    a_picture_loads_with_its_standard_error();
    TEST_END();
}
