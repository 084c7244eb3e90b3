/* Checks the order in which a work-item puts entries of a queue. */
#ifndef EC_TESTS_ORDER_TEST_H
#define EC_TESTS_ORDER_TEST_H

#include "kernel_test.h"

/* Each of the `count` entries from `first` on is there once, by ascending keys and by number within a key, and `first` stands up to the end of the last
 * packet. keys: by entry. */
static void check_order(global test_result *result, const uint *order, const uint *keys, uint first, uint count)
{
    uint sum = 0, last = 0, key = 0;
    for (uint i = 0; i < count; i++) {
        CHECK(order[i] >= first && order[i] < first + count);
        uint next = keys[order[i]];
        if (i) CHECK_UINTS(next > key || (next == key && order[i] > last), key, next, last, order[i]); /* so no entry occurs twice */
        sum += order[i];
        last = order[i];
        key = next;
    }
    CHECK_EQUAL(sum, count * first + count * (count - 1) / 2);
    for (uint i = count; i % LANES; i++) CHECK_EQUAL(order[i], first);
}

#endif
