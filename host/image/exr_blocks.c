#include "image/exr_blocks.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "image/deflate.h"
#include "image/exr_pack.h"

enum { BLOCKS_A_THREAD = 4 };

/* Prepares what OpenEXR's ZIP compresses: even bytes before odd ones, each as the difference from the one before, plus 128 (ImfZip.cpp). */
static void predict(const uint8_t *packed, size_t bytes, uint8_t *to)
{
    const size_t half = (bytes + 1) / 2;
    if (bytes == 0) return;
    to[0] = packed[0];
    for (size_t i = 1; i < half; i++) to[i] = (uint8_t)(packed[2 * i] - packed[2 * i - 2] + 128);
    if (bytes > 1) to[half] = (uint8_t)(packed[1] - packed[2 * half - 2] + 128);
    for (size_t i = 1; i < bytes / 2; i++) to[half + i] = (uint8_t)(packed[2 * i + 1] - packed[2 * i - 1] + 128);
}

/* Makes room for a chunk packed, predicted and compressed. */
static bool make_room(ec_exr_block *b, size_t bytes)
{
    if (!b->deflate) b->deflate = ec_deflate_create();
    const size_t room = 3 * bytes + EC_DEFLATE_PAST;
    if (b->room >= room) return b->deflate != NULL;
    free(b->memory);
    b->memory = malloc(room);
    b->room = b->memory ? room : 0;
    return b->memory != NULL && b->deflate != NULL;
}

/* Sorts the part's channels into the file's order. Returns false if the file has other channels. */
static bool order(exr_const_context_t context, int index, const ec_exr_part *part, const ec_channel **channels)
{
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(context, index, &list) != EXR_ERR_SUCCESS || list->num_channels != (int)part->channel_count) return false;
    for (uint32_t i = 0; i < part->channel_count; i++) {
        channels[i] = NULL;
        for (uint32_t k = 0; k < part->channel_count; k++)
            if (strcmp(part->channels[k].name, list->entries[i].name.str) == 0) channels[i] = &part->channels[k];
        if (!channels[i]) return false;
    }
    return true;
}

/* Encodes rows of the data from `row` on. A chunk that compression would not make smaller is stored as it is packed. */
static exr_result_t encode(ec_exr_block *b, const ec_exr_part *part, const ec_channel *const *channels, uint32_t width, uint32_t row,
                           uint32_t rows)
{
    size_t bytes = 0, at = 0;
    for (uint32_t i = 0; i < part->channel_count; i++) bytes += (size_t)ec_channel_bytes(channels[i]->type) * width * rows;
    if (!make_room(b, bytes)) return EXR_ERR_OUT_OF_MEMORY;
    for (uint32_t y = row; y < row + rows; y++)
        for (uint32_t i = 0; i < part->channel_count; i++) {
            ec_exr_pack(channels[i], (uint64_t)y * width, width, b->memory + at);
            at += (size_t)ec_channel_bytes(channels[i]->type) * width;
        }
    b->data = b->memory;
    b->size = bytes;
    if (part->is_plain) return EXR_ERR_SUCCESS;
    uint8_t *const predicted = b->memory + bytes, *const packed = predicted + bytes + EC_DEFLATE_PAST;
    predict(b->memory, bytes, predicted);
    const size_t size = ec_deflate_pack(b->deflate, EC_DEFLATE_ZLIB, predicted, bytes, packed, bytes - 1);
    if (size > 0) b->data = packed, b->size = size;
    return EXR_ERR_SUCCESS;
}

exr_result_t ec_exr_blocks_create(ec_exr_blocks *blocks)
{
    *blocks = (ec_exr_blocks){.count = BLOCKS_A_THREAD * (uint32_t)omp_get_max_threads()};
    blocks->each = calloc(blocks->count, sizeof *blocks->each);
    return blocks->each ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

exr_result_t ec_exr_blocks_write(ec_exr_blocks *blocks, exr_context_t context, int index, const ec_exr_part *part, uint32_t width,
                                 uint32_t first, uint32_t count, uint32_t block_height)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    const uint32_t chunks = (count + block_height - 1) / block_height;
    const ec_channel *channels[part->channel_count];
    if (!order(context, index, part, channels)) return EXR_ERR_INVALID_ARGUMENT;
    for (uint32_t done = 0; code == EXR_ERR_SUCCESS && done < chunks; done += blocks->count) {
        const uint32_t here = chunks - done < blocks->count ? chunks - done : blocks->count;
        exr_result_t codes[here];
#pragma omp parallel for schedule(dynamic, 1) if (here > 1 && block_height > 1)
        for (uint32_t k = 0; k < here; k++) {
            const uint32_t row = (done + k) * block_height;
            codes[k] = encode(&blocks->each[k], part, channels, width, row, count - row < block_height ? count - row : block_height);
        }
        for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < here; k++) {
            const ec_exr_block *block = &blocks->each[k];
            code = codes[k];
            if (code == EXR_ERR_SUCCESS)
                code = exr_write_scanline_chunk(context, index, (int)(first + (done + k) * block_height), block->data, block->size);
        }
    }
    return code;
}

void ec_exr_blocks_free(ec_exr_blocks *blocks)
{
    for (uint32_t k = 0; blocks->each && k < blocks->count; k++) {
        ec_deflate_free(blocks->each[k].deflate);
        free(blocks->each[k].memory);
    }
    free(blocks->each);
    *blocks = (ec_exr_blocks){0};
}
