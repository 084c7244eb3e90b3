/* Compresses chunks of an EXR part in parallel, and writes them in order. */
#ifndef EC_IMAGE_EXR_BLOCKS_H
#define EC_IMAGE_EXR_BLOCKS_H

#include <openexr.h>

#include "image/image.h"

/* A chunk in progress: packed, predicted and compressed. */
typedef struct ec_exr_block {
    struct ec_deflate *deflate; /* owned; created when needed */
    uint8_t *memory;            /* owned */
    size_t room;
    const uint8_t *data;        /* the part of memory that goes into the file */
    size_t size;
} ec_exr_block;

/* Several for each thread, so that none waits for the slowest one. */
typedef struct ec_exr_blocks {
    ec_exr_block *each; /* owned */
    uint32_t count;
} ec_exr_blocks;

/* Makes room for as many encoders as there are threads; *blocks must be zero. */
exr_result_t ec_exr_blocks_create(ec_exr_blocks *blocks);

/* Writes rows [first, first + count) of part `index`, which must be its next ones, with `block_height` rows per chunk. The data of `part` begin with
 * row `first`. The bytes do not depend on the number of threads. */
exr_result_t ec_exr_blocks_write(ec_exr_blocks *blocks, exr_context_t context, int index, const ec_exr_part *part, uint32_t width,
                                 uint32_t first, uint32_t count, uint32_t block_height);

void ec_exr_blocks_free(ec_exr_blocks *blocks);

#endif
