/* Chunks of an EXR part compressed side by side, and written one after the other. */
#ifndef EC_IMAGE_EXR_BLOCKS_H
#define EC_IMAGE_EXR_BLOCKS_H

#include <openexr.h>

#include "image/image.h"

/* A chunk on its way: 12 bytes a value and a little more, packed, as the predictor leaves it, and compressed. */
typedef struct ec_exr_block {
    exr_encode_pipeline_t pipeline;
    struct libdeflate_compressor *compressor; /* owned; made when it is needed */
    uint8_t *memory;                          /* owned */
    size_t room;
    const void *data;                         /* what goes into the file: the library's memory or ours */
    size_t size;
    bool is_plain;
} ec_exr_block;

/* One for each thread. */
typedef struct ec_exr_blocks {
    ec_exr_block *each;          /* owned */
    uint32_t count;              /* that there are */
    uint32_t made;               /* that have been used for this part: the first ones */
} ec_exr_blocks;

/* Zero-initialised ones are fine; room for as many encoders as there are threads. */
exr_result_t ec_exr_blocks_create(ec_exr_blocks *blocks);

/* Rows [first, first + count) of part `index`, `block_height` a chunk, into the file: its next ones. The data of `part` begin with row
 * `first`. The same bytes for any number of threads. */
exr_result_t ec_exr_blocks_write(ec_exr_blocks *blocks, exr_context_t context, int index, const ec_exr_part *part, uint32_t width,
                                 uint32_t first, uint32_t count, uint32_t block_height);

void ec_exr_blocks_reset(ec_exr_blocks *blocks, exr_const_context_t context); /* before another part */
void ec_exr_blocks_free(ec_exr_blocks *blocks, exr_const_context_t context);

#endif
