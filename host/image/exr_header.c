#include "image/exr_header.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "image/exr_context.h"
#include "image/image.h"

/* NULL where the file cannot be read; whoever reads its pixels says why. */
static exr_context_t open_header(const char *path, ec_exr_stream *stream)
{
    exr_context_t context = NULL;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ec_exr_keep_message;
    setup.user_data = stream;
    if (ec_image_check_regular(path, NULL) != EC_OK) return NULL;
    return exr_start_read(&context, path, &setup) == EXR_ERR_SUCCESS ? context : NULL;
}

int ec_exr_number(const char *path, const char *attribute, double *value)
{
    ec_exr_stream stream = {0};
    exr_context_t context = open_header(path, &stream);
    const exr_attribute_t *found = NULL;
    if (!context) return 0;
    int is_number = exr_get_attribute_by_name(context, 0, attribute, &found) == EXR_ERR_SUCCESS;
    if (is_number && found->type == EXR_ATTR_INT)
        *value = found->i;
    else if (is_number && found->type == EXR_ATTR_FLOAT)
        *value = found->f;
    else if (is_number && found->type == EXR_ATTR_DOUBLE)
        *value = found->d;
    else
        is_number = 0;
    exr_finish(&context);
    return is_number;
}

/* Its last line's block, whole? Blocks may stand in any order, but are written in theirs. */
static int is_whole(const char *path, exr_context_t context)
{
    exr_attr_box2i_t window;
    exr_chunk_info_t last;
    struct stat file;
    return exr_get_data_window(context, 0, &window) == EXR_ERR_SUCCESS &&
           exr_read_scanline_chunk_info(context, 0, window.max.y, &last) == EXR_ERR_SUCCESS && stat(path, &file) == 0 &&
           last.data_offset + last.packed_size <= (uint64_t)file.st_size;
}

static char *text_of(const char *path, const char *attribute, int whole_only)
{
    ec_exr_stream stream = {0};
    exr_context_t context = open_header(path, &stream);
    const char *text = NULL;
    int32_t size = 0;
    char *copy = NULL;
    if (!context) return NULL;
    if ((!whole_only || is_whole(path, context)) &&
        exr_attr_get_string(context, 0, attribute, &size, &text) == EXR_ERR_SUCCESS && text)
        copy = strndup(text, (size_t)size);
    exr_finish(&context);
    return copy;
}

char *ec_exr_header_text(const char *path, const char *attribute) { return text_of(path, attribute, 0); }

char *ec_exr_whole_text(const char *path, const char *attribute) { return text_of(path, attribute, 1); }

int ec_exr_is_half(const char *path, const char *channel)
{
    ec_exr_stream stream = {0};
    exr_context_t context = open_header(path, &stream);
    const exr_attr_chlist_t *list = NULL;
    int is_half = 0;
    if (!context) return 0;
    if (exr_get_channels(context, 0, &list) != EXR_ERR_SUCCESS) list = NULL;
    for (int i = 0; list && i < list->num_channels; i++)
        is_half |= !strcmp(list->entries[i].name.str, channel) && list->entries[i].pixel_type == EXR_PIXEL_HALF;
    exr_finish(&context);
    return is_half;
}
