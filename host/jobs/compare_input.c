#include "jobs/compare_input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/luminance.h"
#include "image/image.h"

static ec_result read_radiance(const char *path, ec_compare_input *input, ec_error *err)
{
    uint32_t width, height;
    EC_TRY(ec_image_read_rgb(path, &width, &height, &input->rgb, err));
    input->path = path;
    input->measured = (ec_measured){.width = width, .height = height, .rgb = input->rgb, .replicates = INFINITY};
    if (!(input->slack = malloc(3ull * width * height * sizeof(float)))) return ec_fail(err, "out of memory for '%s'", path);
    for (uint64_t p = 0; p < (uint64_t)width * height; p++) {
        const float *rgb = input->rgb + 3 * p, step = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])) / 128; /* 8 bits of the largest component, whose first bit is 1 */
        if (!isfinite(rgb[0] + rgb[1] + rgb[2])) return ec_fail(err, "cannot compare '%s': its values are not finite", path);
        for (uint64_t c = 0; c < 3; c++) input->slack[3 * p + c] = step;
    }
    input->measured.slack = input->slack;
    return EC_OK;
}

/* Reads any kind. A file that cannot be opened, or whose content is not recognised, is treated by its name. */
ec_result ec_compare_read(const char *path, ec_compare_input *input, ec_error *err)
{
    static const char *const endings[] = {".png", ".jpg", ".jpeg", ".webp", ".avif"};
    static const unsigned char exr[4] = {0x76, 0x2f, 0x31, 0x01}, png[4] = {0x89, 'P', 'N', 'G'}, jpeg[3] = {0xff, 0xd8, 0xff};
    unsigned char head[12] = {0};
    EC_TRY(ec_image_check_regular(path, err));
    FILE *file = fopen(path, "rb");
    if (file) {
        size_t got = fread(head, 1, sizeof head, file);
        fclose(file);
        if (got >= 4 && !memcmp(head, exr, 4)) return ec_compare_read_exr(path, input, err);
        if (!memcmp(head, "#?", 2)) return read_radiance(path, input, err);
        if (!memcmp(head, png, 4) || !memcmp(head, jpeg, 3) || !memcmp(head + 8, "WEBP", 4) || !memcmp(head + 4, "ftyp", 4))
            return ec_compare_read_picture(path, input, err);
        for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
            if (strlen(path) > strlen(endings[i]) && !strcasecmp(path + strlen(path) - strlen(endings[i]), endings[i]))
                return ec_compare_read_picture(path, input, err);
    }
    return ec_compare_read_exr(path, input, err);
}

void ec_compare_input_free(ec_compare_input *input)
{
    free(input->rgb);
    free(input->se);
    free(input->se_y);
    free(input->slack);
    free(input->tail_se);
    free(input->mask);
    free(input->why);
    *input = (ec_compare_input){0};
}

ec_result ec_compare_read_mask(const char *path, uint32_t width, uint32_t height, uint8_t **mask, ec_error *err)
{
    ec_compare_input input = {0};
    ec_result result;
    uint64_t pixels = (uint64_t)width * height;
    EC_TRY_CLEANUP(ec_compare_read(path, &input, err));
    result = EC_FAILED;
    if (input.measured.width != width || input.measured.height != height)
        ec_fail(err, "cannot use the mask '%s': %ux%u pixels against %ux%u of the pictures; save it in their size", path, input.measured.width,
                input.measured.height, width, height);
    else if (!(*mask = malloc(pixels)))
        ec_fail(err, "out of memory for the mask '%s'", path);
    else {
        for (uint64_t p = 0; p < pixels; p++) (*mask)[p] = (!input.mask || input.mask[p]) && ec_luminance_of_floats(input.rgb + 3 * p) >= 0.5;
        result = EC_OK;
    }
cleanup:
    ec_compare_input_free(&input);
    return result;
}
