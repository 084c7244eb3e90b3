/* Radiance .hdr in, through stb_image. Static: tinygltf's library may carry another copy of the same symbols. */
#pragma GCC diagnostic ignored "-Wunused-function" /* reported at the end of the file: no push and pop */
#pragma GCC diagnostic ignored "-Wunused-parameter"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS (1 << 17)
#include <stb_image.h>

#include <stdio.h>

#include "image/hdr.h"

/* stb_image takes the end of the file for an endless run of zeros. It asks for more only when it needs more, so an
 * empty answer means a file cut short. */
typedef struct hdr_source {
    FILE *file;
    int cut_short;
} hdr_source;

static int source_read(void *user, char *data, int size)
{
    hdr_source *source = user;
    size_t count = fread(data, 1, (size_t)size, source->file);
    if (count == 0) source->cut_short = 1;
    return (int)count;
}

static void source_skip(void *user, int count)
{
    fseek(((hdr_source *)user)->file, count, SEEK_CUR);
}

static int source_eof(void *user)
{
    hdr_source *source = user;
    return feof(source->file) || ferror(source->file);
}

ec_result ec_hdr_read(FILE *file, const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err)
{
    static const stbi_io_callbacks callbacks = {source_read, source_skip, source_eof};
    hdr_source source = {.file = file};
    int w = 0, h = 0, components = 0;
    *rgb = stbi_loadf_from_callbacks(&callbacks, &source, &w, &h, &components, 3);
    if (*rgb && !source.cut_short) {
        *width = (uint32_t)w;
        *height = (uint32_t)h;
        return EC_OK;
    }
    const char *reason = *rgb || source.cut_short ? "it ends too early" : stbi_failure_reason();
    stbi_image_free(*rgb);
    *rgb = NULL;
    return ec_fail(err, "cannot read '%s': %s; the file may be damaged or not a run-length encoded RGBE picture", path,
                   reason);
}
