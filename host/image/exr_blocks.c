#include "image/exr_blocks.h"

#include <libdeflate.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { LEVEL = 4 }; /* OpenEXR's own since 3.1.3 */

/* Points every channel of the block (the library's order: sorted by name) at the caller's pixels, row y on. */
static void point_at_row(exr_encode_pipeline_t *block, const ec_exr_part *part, uint32_t width, uint32_t y)
{
    for (int c = 0; c < block->channel_count; c++) {
        exr_coding_channel_info_t *target = &block->channels[c];
        for (uint32_t i = 0; i < part->channel_count; i++) {
            const ec_channel *source = &part->channels[i];
            if (strcmp(source->name, target->channel_name) != 0) continue;
            const float *first = source->data + (uint64_t)source->stride * y * width;
            target->user_data_type = source->is_words ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            target->user_bytes_per_element = sizeof(float);
            target->user_pixel_stride = (int32_t)(source->stride * sizeof(float));
            target->user_line_stride = (int32_t)(source->stride * sizeof(float) * width);
            target->encode_from_ptr = (const uint8_t *)first;
        }
    }
}

/* What OpenEXR's ZIP compresses: even bytes before odd ones, each as its difference from the one before, off by 128 (ImfZip.cpp). */
static void predict(const uint8_t *packed, size_t bytes, uint8_t *to)
{
    const size_t half = (bytes + 1) / 2;
    for (size_t i = 0; i < bytes / 2; i++) to[i] = packed[2 * i], to[half + i] = packed[2 * i + 1];
    if (bytes & 1) to[half - 1] = packed[bytes - 1];
    for (size_t i = bytes; i-- > 1;) to[i] = (uint8_t)(to[i] - to[i - 1] + 128);
}

static bool make_room(ec_exr_block *b, size_t bytes)
{
    const size_t bound = libdeflate_zlib_compress_bound(b->compressor, bytes);
    if (b->room >= bytes + bound) return true;
    free(b->memory);
    b->memory = malloc(bytes + bound);
    b->room = b->memory ? bytes + bound : 0;
    return b->memory != NULL;
}

/* A chunk that would not get smaller is stored as it is packed. */
static exr_result_t compress(ec_exr_block *b)
{
    const size_t bytes = b->pipeline.packed_bytes;
    b->data = b->pipeline.packed_buffer;
    b->size = bytes;
    if (b->is_plain || bytes == 0) return EXR_ERR_SUCCESS;
    if (!b->compressor) b->compressor = libdeflate_alloc_compressor(LEVEL);
    if (!b->compressor || !make_room(b, bytes)) return EXR_ERR_OUT_OF_MEMORY;
    predict(b->pipeline.packed_buffer, bytes, b->memory);
    const size_t size = libdeflate_zlib_compress(b->compressor, b->memory, bytes, b->memory + bytes, b->room - bytes);
    if (size > 0 && size < bytes) b->data = b->memory + bytes, b->size = size;
    return EXR_ERR_SUCCESS;
}

/* Row `row` of the part, which is row `from` of the data, into the block. The library packs and does nothing else: it would compress by zlib,
 * and chunks are written in order afterwards. */
static exr_result_t encode(ec_exr_block *b, bool is_new, exr_context_t context, int index, const ec_exr_part *part,
                           uint32_t width, uint32_t row, uint32_t from)
{
    exr_encode_pipeline_t *block = &b->pipeline;
    exr_chunk_info_t info;
    exr_result_t code = exr_write_scanline_chunk_info(context, index, (int)row, &info);
    if (code != EXR_ERR_SUCCESS) return code;
    code = is_new ? exr_encoding_initialize(context, index, &info, block) : exr_encoding_update(context, index, &info, block);
    if (code != EXR_ERR_SUCCESS) return code;
    point_at_row(block, part, width, from);
    if (is_new) code = exr_encoding_choose_default_routines(context, index, block);
    block->compress_fn = NULL;
    block->yield_until_ready_fn = NULL;
    block->write_fn = NULL;
    b->is_plain = part->is_plain;
    if (code == EXR_ERR_SUCCESS) code = exr_encoding_run(context, index, block);
    return code == EXR_ERR_SUCCESS ? compress(b) : code;
}

exr_result_t ec_exr_blocks_create(ec_exr_blocks *blocks)
{
    *blocks = (ec_exr_blocks){.count = (uint32_t)omp_get_max_threads()};
    blocks->each = calloc(blocks->count, sizeof *blocks->each);
    return blocks->each ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

exr_result_t ec_exr_blocks_write(ec_exr_blocks *blocks, exr_context_t context, int index, const ec_exr_part *part, uint32_t width,
                                 uint32_t first, uint32_t count, uint32_t block_height)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    const uint32_t chunks = (count + block_height - 1) / block_height;
    for (uint32_t done = 0; code == EXR_ERR_SUCCESS && done < chunks; done += blocks->count) {
        const uint32_t here = chunks - done < blocks->count ? chunks - done : blocks->count;
        exr_result_t codes[here];
        for (uint32_t k = blocks->made; k < here; k++) blocks->each[k].pipeline = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
#pragma omp parallel for schedule(static, 1) num_threads((int)here) if (here > 1 && block_height > 1)
        for (uint32_t k = 0; k < here; k++)
            codes[k] = encode(&blocks->each[k], k >= blocks->made, context, index, part, width, first + (done + k) * block_height,
                              (done + k) * block_height);
        if (blocks->made < here) blocks->made = here;
        for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < here; k++) {
            const ec_exr_block *block = &blocks->each[k];
            code = codes[k];
            if (code == EXR_ERR_SUCCESS) code = exr_write_scanline_chunk(context, index, block->pipeline.chunk.start_y, block->data, block->size);
        }
    }
    return code;
}

void ec_exr_blocks_reset(ec_exr_blocks *blocks, exr_const_context_t context)
{
    for (uint32_t k = 0; k < blocks->made; k++) exr_encoding_destroy(context, &blocks->each[k].pipeline);
    blocks->made = 0;
}

void ec_exr_blocks_free(ec_exr_blocks *blocks, exr_const_context_t context)
{
    ec_exr_blocks_reset(blocks, context);
    for (uint32_t k = 0; blocks->each && k < blocks->count; k++) {
        if (blocks->each[k].compressor) libdeflate_free_compressor(blocks->each[k].compressor);
        free(blocks->each[k].memory);
    }
    free(blocks->each);
    *blocks = (ec_exr_blocks){0};
}
