/* Reads an environment map, OpenEXR or Radiance by content, not by name. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/hdr.h"
#include "image/image.h"

/* Reads R, G and B of an EXR, or three times its luminance Y. */
static ec_result exr_to_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err)
{
    ec_exr exr;
    EC_TRY(ec_exr_read(path, &exr, err));
    ec_result result = EC_OK;
    const float *planes[3] = {ec_exr_plane(&exr, "R"), ec_exr_plane(&exr, "G"), ec_exr_plane(&exr, "B")};
    if (!planes[0] && !planes[1] && !planes[2]) planes[0] = planes[1] = planes[2] = ec_exr_plane(&exr, "Y");
    uint64_t pixels = (uint64_t)exr.width * exr.height;
    if (!planes[0] || !planes[1] || !planes[2])
        result = ec_fail(err, "cannot read '%s': it has no channels R, G, B (or Y); its first channel is '%s'", path,
                         exr.names[0]);
    else if (!(*rgb = malloc(pixels * 3 * sizeof(float))))
        result = ec_fail(err, "cannot read '%s': %u x %u pixels do not fit into memory", path, exr.width, exr.height);
    if (result == EC_OK) {
        for (uint64_t i = 0; i < pixels; i++)
            for (int c = 0; c < 3; c++) (*rgb)[3 * i + c] = planes[c][i];
        *width = exr.width;
        *height = exr.height;
    }
    ec_exr_free(&exr);
    return result;
}

ec_result ec_image_read_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err)
{
    static const unsigned char exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};
    *rgb = NULL;
    EC_TRY(ec_image_check_regular(path, err));
    FILE *file = fopen(path, "rb");
    if (!file) return ec_fail(err, "cannot open '%s': %s", path, strerror(errno));
    setvbuf(file, NULL, _IOFBF, 1 << 16);
    unsigned char start[4] = {0};
    errno = 0;
    size_t count = fread(start, 1, sizeof start, file);
    ec_result result;
    if (count < sizeof start)
        result = ec_fail(err, "cannot read '%s': %s", path, errno ? strerror(errno) : "the file is empty or cut short");
    else if (memcmp(start, exr_magic, sizeof start) == 0)
        result = exr_to_rgb(path, width, height, rgb, err);
    else if (start[0] == '#' && start[1] == '?' && fseek(file, 0, SEEK_SET) == 0)
        result = ec_hdr_read(file, path, width, height, rgb, err);
    else
        result = ec_fail(err, "cannot read '%s': it is neither OpenEXR nor Radiance .hdr; convert it to one of them",
                         path);
    fclose(file);
    return result;
}
