/* tier: quick */
/* Layers that add up to a picture: the sum is exact for all numbers, and corrections are no larger than its rounding. */
#include <math.h>

#include "film/layer_films.h"
#include "support/random.h"
#include "support/test.h"

static float sum_of(const float *numbers, uint32_t count, uint32_t stride)
{
    float sum = numbers[0];
    for (uint32_t k = 1; k < count; k++) sum += numbers[k * stride];
    return sum;
}

int main(void)
{
    enum { CASES = 400000, MOST = 16, STRIDE = 7 };
    test_random numbers = {5};
    double worst = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        float parts[MOST * STRIDE], before[MOST];
        const uint32_t count = 1 + (uint32_t)(test_uniform(&numbers) * MOST);
        double sum = 0;
        for (uint32_t k = 0; k < count; k++) {
            before[k] = parts[k * STRIDE] = (float)(test_uniform(&numbers) * exp2(i % 3 ? floor(40 * test_uniform(&numbers)) - 20 : 0));
            sum += before[k];
        }
        const float wanted = (float)(sum * (1 + (i % 5) * 3e-7 * (test_uniform(&numbers) - 0.5)));
        ec_sum_to(parts, count, STRIDE, wanted);
        CHECK_MSG(sum_of(parts, count, STRIDE) == wanted, "case %u: %u numbers add up to %.9g, not to %.9g", i, count, (double)sum_of(parts, count, STRIDE), (double)wanted);
        for (uint32_t k = 0; k < count; k++) worst = fmax(worst, fabs((double)parts[k * STRIDE] - before[k]) / wanted);
    }
    CHECK_MSG(worst < 4e-6, "a number moved by %.2g of the sum", worst);
    float zero[2] = {0, 0};
    ec_sum_to(zero, 2, 1, 0);
    CHECK(zero[0] == 0 && zero[1] == 0);
    TEST_END();
}
