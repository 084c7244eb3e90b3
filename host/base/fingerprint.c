#include "base/fingerprint.h"

#include <string.h>

#include "base/random.h"

enum { LANES = 4 };

/* Mixes a word into a lane, bijectively: different lanes stay different. */
static uint64_t turn(uint64_t lane, uint64_t word)
{
    lane = (lane ^ word) * UINT64_C(0x9fb21c651e98df25);
    return lane ^ (lane >> 32);
}

ec_fingerprint ec_fingerprint_add(ec_fingerprint f, const void *bytes, uint64_t size)
{
    const uint8_t *at = bytes;
    uint64_t lane[LANES] = {f.half[0], f.half[1], ~f.half[0], size}, left = size, word[LANES];
    for (; left >= sizeof word; left -= sizeof word, at += sizeof word) {
        memcpy(word, at, sizeof word);
        for (int k = 0; k < LANES; k++) lane[k] = turn(lane[k], word[k]);
    }
    memset(word, 0, sizeof word);
    if (left) memcpy(word, at, left);
    for (int k = 0; k < LANES; k++) lane[k] = turn(lane[k], word[k]);
    ec_fingerprint sum = {{size, ~size}};
    for (int k = 0; k < LANES; k++) {
        sum.half[0] = ec_random_mix(sum.half[0] + lane[k]);
        sum.half[1] = ec_random_mix(sum.half[1] ^ (lane[k] + EC_RANDOM_STEP * (uint64_t)(k + 1)));
    }
    return sum;
}
