#include "image/exr_header.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "image/exr_input.h"
#include "image/image.h"

/* Returns false if the file cannot be read; reading its pixels tells why. */
static bool open_header(ec_exr_input *input, const char *path)
{
    *input = (ec_exr_input){.path = path};
    return ec_image_check_regular(path, NULL) == EC_OK && ec_exr_input_open(input, path) == EXR_ERR_SUCCESS;
}

static bool number_of(const exr_attribute_t *attribute, double *value)
{
    switch (attribute->type) {
    case EXR_ATTR_INT: *value = attribute->i; return true;
    case EXR_ATTR_FLOAT: *value = attribute->f; return true;
    case EXR_ATTR_DOUBLE: *value = attribute->d; return true;
    default: return false;
    }
}

int ec_exr_number(const char *path, const char *attribute, double *value)
{
    ec_exr_input input;
    const exr_attribute_t *found = NULL;
    bool is_number = open_header(&input, path) &&
                     exr_get_attribute_by_name(input.context, 0, attribute, &found) == EXR_ERR_SUCCESS && number_of(found, value);
    ec_exr_input_close(&input);
    return is_number;
}

/* Tells whether the block of the last line is complete. Blocks may be in any order, but are written in theirs. */
static bool is_whole(const ec_exr_input *input)
{
    exr_attr_box2i_t window;
    exr_chunk_info_t last;
    struct stat file;
    return exr_get_data_window(input->context, 0, &window) == EXR_ERR_SUCCESS &&
           exr_read_scanline_chunk_info(input->context, 0, window.max.y, &last) == EXR_ERR_SUCCESS && stat(input->path, &file) == 0 &&
           last.data_offset + last.packed_size <= (uint64_t)file.st_size;
}

static char *text_of(const char *path, const char *attribute, bool whole_only)
{
    ec_exr_input input;
    const char *text = NULL;
    int32_t size = 0;
    bool found = open_header(&input, path) && (!whole_only || is_whole(&input)) &&
                 exr_attr_get_string(input.context, 0, attribute, &size, &text) == EXR_ERR_SUCCESS && text;
    char *copy = found ? strndup(text, (size_t)size) : NULL;
    ec_exr_input_close(&input);
    return copy;
}

char *ec_exr_header_text(const char *path, const char *attribute) { return text_of(path, attribute, false); }

char *ec_exr_whole_text(const char *path, const char *attribute) { return text_of(path, attribute, true); }

int ec_exr_is_half(const char *path, const char *channel)
{
    ec_exr_input input;
    const exr_attr_chlist_entry_t *entry = open_header(&input, path) ? ec_exr_channel(&input, 0, channel) : NULL;
    bool is_half = entry && entry->pixel_type == EXR_PIXEL_HALF;
    ec_exr_input_close(&input);
    return is_half;
}
