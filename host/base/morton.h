/* Morton codes (Morton 1966): a curve through a grid that mostly goes on to a neighbour. */
#ifndef EC_BASE_MORTON_H
#define EC_BASE_MORTON_H

#include <stdint.h>

/* Spreads the lowest 21 bits of x to every third bit from bit 0 on. */
static inline uint64_t ec_spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/* Interleaves the bits of three numbers below 2^21, the first one's being the highest. */
static inline uint64_t ec_morton(const uint32_t at[3]) { return ec_spread_bits(at[0]) << 2 | ec_spread_bits(at[1]) << 1 | ec_spread_bits(at[2]); }

#endif
