/* When an error target is looked at: often enough, seldom enough for blocks of batches in between. */
#include "pipeline/looks.h"
#include "support/test.h"

int main(void)
{
    uint64_t looks = 0;
    for (uint64_t n = 0, next; n < 3000000; n = next) {
        next = ec_look_after(n);
        CHECK(next > n && ec_look_is_due(next));
        CHECK_MSG(n < 256 ? next == n + 1 : (next - n) * 16 <= n, "from %llu to %llu", (unsigned long long)n, (unsigned long long)next);
        for (uint64_t k = n + 1; k < next && k < n + 1000; k++) CHECK(!ec_look_is_due(k) && ec_look_after(k) == next);
        const uint64_t block = n >= 4096 ? 256 : 16;
        if (n >= 256) CHECK_MSG(n % block == 0 && next % block == 0, "a block of %llu is cut at %llu", (unsigned long long)block, (unsigned long long)next);
        looks++;
    }
    CHECK(!ec_look_is_due(0) && ec_look_after(256) == 272 && ec_look_after(511) == 512 && ec_look_after(512) == 544);
    CHECK_MSG(looks < 256 + 16 * 14, "%llu looks", (unsigned long long)looks);
    TEST_END();
}
