/* Convert a float to its 32 bits, and back. */
#ifndef EC_BASE_BITS_H
#define EC_BASE_BITS_H

#include <stdint.h>
#include <string.h>

static inline float ec_float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint32_t ec_bits_of_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

#endif
