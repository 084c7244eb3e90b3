/* After how many batches is an error target looked at? After each of the first 256. From there on a look every so many that it comes at most a
 * sixteenth of the batches late: every 16th up to 512, every 32nd up to 1024, every 256th from 4096 on. Between two looks nothing is decided,
 * so that others may take these batches and send one sum. Whoever renders, the picture stops at the same batch. */
#ifndef EC_PIPELINE_LOOKS_H
#define EC_PIPELINE_LOOKS_H

#include <stdbool.h>
#include <stdint.h>

#define EC_LOOKS_EACH 256u /* a power of two, 16 at least */

/* The next one, after more than `batches`. */
static inline uint64_t ec_look_after(uint64_t batches)
{
    uint64_t step = 1;
    if (batches < EC_LOOKS_EACH) return batches + 1;
    while (batches / step >= 32) step *= 2; /* 16 to 31 steps */
    return (batches / step + 1) * step;
}

static inline bool ec_look_is_due(uint64_t batches) { return batches > 0 && ec_look_after(batches - 1) == batches; }

#endif
