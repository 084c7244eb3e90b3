#include "image/exr_input.h"

#include <stdio.h>
#include <string.h>

#include "base/freed.h"

/* Callback of the library: keeps its first message. */
static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    ec_exr_input *input = user;
    if (input->message[0]) return;
    snprintf(input->message, sizeof input->message, "%s", message);
    for (char *c = input->message; *c; c++)
        if (*c == '\n' || *c == '\r') *c = ' ';
}

static exr_result_t open_by(ec_exr_input *input, const char *path, int flags)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    *input = (ec_exr_input){.path = path};
    setup.error_handler_fn = keep_message;
    setup.user_data = input;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION | flags;
    return exr_start_read(&input->context, path, &setup);
}

exr_result_t ec_exr_input_open(ec_exr_input *input, const char *path) { return open_by(input, path, 0); }

exr_result_t ec_exr_input_open_strictly(ec_exr_input *input, const char *path) { return open_by(input, path, EXR_CONTEXT_FLAG_STRICT_HEADER); }

void ec_exr_input_close(ec_exr_input *input)
{
    if (input->context) exr_finish(&input->context);
}

const char *ec_exr_reason(const ec_exr_input *input, exr_result_t code)
{
    return input->message[0] ? input->message : exr_get_default_error_message(code);
}

const exr_attr_chlist_entry_t *ec_exr_channel(const ec_exr_input *input, int part, const char *name)
{
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(input->context, part, &list) != EXR_ERR_SUCCESS) return NULL;
    for (int i = 0; i < list->num_channels; i++)
        if (!strcmp(list->entries[i].name.str, name)) return &list->entries[i];
    return NULL;
}

/* State that decoding all chunks of a part shares. */
typedef struct decoding {
    exr_context_t context;
    int part;
    exr_decode_pipeline_t pipeline;
    exr_attr_box2i_t window;
    uint64_t width, height;
    const ec_exr_room *rooms;
    uint32_t count;
    bool as_floats;
    float *unwanted; /* a line for unwanted channels, which not all routines of the library can skip */
} decoding;

/* Directs a channel of the chunk that begins at pixel (x, y) to its room. */
static void place(const decoding *d, exr_coding_channel_info_t *channel, uint64_t x, uint64_t y)
{
    const ec_exr_room *room = NULL;
    for (uint32_t i = 0; i < d->count && !room; i++)
        if (!strcmp(d->rooms[i].name, channel->channel_name)) room = &d->rooms[i];
    const uint64_t stride = room ? room->stride : 1;
    channel->user_data_type = d->as_floats ? EXR_PIXEL_FLOAT : channel->data_type;
    channel->user_bytes_per_element = sizeof(float);
    channel->user_pixel_stride = (int32_t)(stride * sizeof(float));
    channel->user_line_stride = room ? (int32_t)(stride * sizeof(float) * d->width) : 0;
    channel->decode_to_ptr = (uint8_t *)(room ? (float *)room->data + stride * (y * d->width + x) : d->unwanted);
}

static exr_result_t decode_chunk(decoding *d, const exr_chunk_info_t *info, uint64_t x, uint64_t y)
{
    exr_decode_pipeline_t *p = &d->pipeline;
    exr_result_t code = p->channels ? exr_decoding_update(d->context, d->part, info, p) : exr_decoding_initialize(d->context, d->part, info, p);
    if (code != EXR_ERR_SUCCESS) return code;
    if (info->width < 1 || info->height < 1 || x + (uint64_t)info->width > d->width || y + (uint64_t)info->height > d->height)
        return EXR_ERR_CORRUPT_CHUNK;
    for (int c = 0; c < p->channel_count; c++) place(d, &p->channels[c], x, y);
    code = exr_decoding_choose_default_routines(d->context, d->part, p);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(d->context, d->part, p) : code;
}

/* Decodes all chunks. Scan lines are treated as tiles as wide as the picture. */
static exr_result_t decode_chunks(decoding *d, bool is_tiled)
{
    int32_t wide = INT32_MAX, high = 1;
    exr_result_t code = is_tiled ? exr_get_tile_sizes(d->context, d->part, 0, 0, &wide, &high)
                                 : exr_get_scanlines_per_chunk(d->context, d->part, &high);
    if (code == EXR_ERR_SUCCESS && (wide < 1 || high < 1)) code = EXR_ERR_FILE_BAD_HEADER;
    for (uint64_t y = 0; code == EXR_ERR_SUCCESS && y < d->height; y += (uint64_t)high)
        for (uint64_t x = 0; code == EXR_ERR_SUCCESS && x < d->width; x += (uint64_t)wide) {
            exr_chunk_info_t info;
            code = is_tiled ? exr_read_tile_chunk_info(d->context, d->part, (int)x / wide, (int)y / high, 0, 0, &info)
                            : exr_read_scanline_chunk_info(d->context, d->part, d->window.min.y + (int)y, &info);
            if (code == EXR_ERR_SUCCESS) code = decode_chunk(d, &info, x, y);
        }
    return code;
}

exr_result_t ec_exr_decode(const ec_exr_input *input, int part, const ec_exr_room *rooms, uint32_t count, bool as_floats)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    decoding d = {.context = input->context, .part = part, .pipeline = EXR_DECODE_PIPELINE_INITIALIZER, .rooms = rooms, .count = count,
                  .as_floats = as_floats};
    exr_result_t code = exr_get_data_window(d.context, part, &d.window);
    if (code == EXR_ERR_SUCCESS) code = exr_get_storage(d.context, part, &storage);
    if (code != EXR_ERR_SUCCESS) return code;
    d.width = (uint64_t)((int64_t)d.window.max.x - d.window.min.x + 1);
    d.height = (uint64_t)((int64_t)d.window.max.y - d.window.min.y + 1);
    EC_FREED float *line = malloc(d.width * sizeof *line);
    if (!line) return EXR_ERR_OUT_OF_MEMORY;
    d.unwanted = line;
    code = decode_chunks(&d, storage == EXR_STORAGE_TILED);
    exr_decoding_destroy(d.context, &d.pipeline);
    return code;
}
