/* Chunks of an EXR part compressed side by side, and written one after the other. */
#ifndef EC_IMAGE_EXR_BLOCKS_H
#define EC_IMAGE_EXR_BLOCKS_H

#include <openexr.h>

#include "image/image.h"

/* A chunk on its way: packed, as the predictor leaves it, and compressed. */
typedef struct ec_exr_block {
    struct ec_deflate *deflate; /* owned; made when it is needed */
    uint8_t *memory;            /* owned */
    size_t room;
    const uint8_t *data;        /* what of that goes into the file */
    size_t size;
} ec_exr_block;

/* Several for each thread, so that none waits for the slowest. */
typedef struct ec_exr_blocks {
    ec_exr_block *each; /* owned */
    uint32_t count;
} ec_exr_blocks;

/* Zero-initialised ones are fine; room for as many encoders as there are threads. */
exr_result_t ec_exr_blocks_create(ec_exr_blocks *blocks);

/* Rows [first, first + count) of part `index`, `block_height` a chunk, into the file: its next ones. The data of `part` begin with row
 * `first`. The same bytes for any number of threads. */
exr_result_t ec_exr_blocks_write(ec_exr_blocks *blocks, exr_context_t context, int index, const ec_exr_part *part, uint32_t width,
                                 uint32_t first, uint32_t count, uint32_t block_height);

void ec_exr_blocks_free(ec_exr_blocks *blocks);

#endif
