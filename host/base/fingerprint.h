/* 128 bits that distinguish byte sequences, computed at the speed of memory. Not secure against manipulation. */
#ifndef EC_BASE_FINGERPRINT_H
#define EC_BASE_FINGERPRINT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct ec_fingerprint {
    uint64_t half[2];
} ec_fingerprint;

/* so_far: fingerprint of what came before; {0} at first. */
ec_fingerprint ec_fingerprint_add(ec_fingerprint so_far, const void *bytes, uint64_t size);

static inline bool ec_fingerprint_is(ec_fingerprint a, ec_fingerprint b)
{
    return a.half[0] == b.half[0] && a.half[1] == b.half[1];
}

#endif
