/* tier: quick */
/* Values stored in fewer bits: nearest half floats, and whole numbers. */
#include <math.h>

#include "image/exr_header.h"
#include "image/image.h"
#include "support/test.h"

static const char *const out = ECLAT_TEST_OUT "/types.exr";
static ec_error err;

enum { W = 401, H = 37, P = W * H };

/* Floats of all magnitudes, most of them near those of a half, and both signs. */
static float value_at(uint32_t i)
{
    static const float special[] = {0, -0.0f, 1, 65504, 65519, 65520, 1e30f, -1e30f, 0x1p-14f, 0x1p-24f, 0x1p-25f, 0x1p-26f, 1e-40f, 0x1.ffcp-15f, 0x1.002p0f, 0x1.006p0f};
    const uint32_t word = i * 2654435761u;
    if (i < sizeof special / sizeof *special) return special[i];
    return ldexpf((float)(word >> 8) - 0x1p23f, (int)(i % 48) - 47);
}

/* The definition in double precision: 11 bits from 2^-14 on, steps of 2^-24 below. Nothing is rounded to 0 or to infinity. */
static float nearest(float value)
{
    int exponent;
    const double size = fabs((double)value);
    frexp(size, &exponent);
    const double step = ldexp(1, exponent - 11 > -24 ? exponent - 11 : -24), rounded = fmin(nearbyint(size / step) * step, 65504);
    return (float)copysign(size > 0 ? fmax(rounded, 0x1p-24) : 0, (double)value);
}

static void halves_are_the_nearest_ones(void)
{
    static float values[P], whole[P];
    for (uint32_t i = 0; i < P; i++) values[i] = value_at(i), whole[i] = (float)(i * 1117 % 16777217);
    const ec_channel channels[] = {{"stderr.Y", values, 1, EC_CHANNEL_HALF}, {"R", values, 1, EC_CHANNEL_FLOAT}, {"samples", whole, 1, EC_CHANNEL_UINT}};
    CHECK_OK(ec_exr_write(out, W, H, channels, 3, NULL, 0, &err), err);
    CHECK(ec_exr_is_half(out, "stderr.Y") && !ec_exr_is_half(out, "R") && !ec_exr_is_half(out, "samples"));

    ec_exr exr;
    CHECK_OK(ec_exr_read(out, &exr, &err), err);
    const float *half = ec_exr_plane(&exr, "stderr.Y"), *samples = ec_exr_plane(&exr, "samples");
    CHECK(half && samples && !memcmp(ec_exr_plane(&exr, "R"), values, sizeof values));
    for (uint32_t i = 0; i < P; i++) {
        CHECK_MSG(half[i] == nearest(values[i]) && !signbit(half[i]) == !signbit(values[i]), "%a becomes %a", (double)values[i], (double)half[i]);
        CHECK(samples[i] == whole[i]);
    }
    ec_exr_free(&exr);
}

static void what_is_not_finite_stays_so(void)
{
    const float values[] = {INFINITY, -INFINITY, NAN};
    const ec_channel channel = {"stderr.Y", values, 1, EC_CHANNEL_HALF};
    CHECK_OK(ec_exr_write(out, 3, 1, &channel, 1, NULL, 0, &err), err);
    ec_exr exr;
    CHECK_OK(ec_exr_read(out, &exr, &err), err);
    const float *read = ec_exr_plane(&exr, "stderr.Y");
    CHECK(read[0] == INFINITY && read[1] == -INFINITY && isnan(read[2]));
    ec_exr_free(&exr);
}

int main(void)
{
    halves_are_the_nearest_ones();
    what_is_not_finite_stays_so();
    TEST_END();
}
