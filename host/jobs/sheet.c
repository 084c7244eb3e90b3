#include "jobs/sheet.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "image/exr_header.h"
#include "image/image.h"
#include "image/label.h"
#include "jobs/numbers.h"
#include "report/names.h"

enum { CELL = 192, GAP = 8, GROUND = 32, INK = 208, SIDE_MOST = 32768 };

typedef struct small {
    uint32_t width, height;
    uint8_t *rgb; /* sRGB, owned */
} small;

static bool read_png(const char *path, small *picture)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    const png_color ground = {GROUND, GROUND, GROUND};
    if (!png_image_begin_read_from_file(&image, path)) return false;
    image.format = PNG_FORMAT_RGB;
    *picture = (small){image.width, image.height, malloc(PNG_IMAGE_SIZE(image))};
    const bool is_read = picture->rgb && png_image_finish_read(&image, &ground, picture->rgb, 0, NULL);
    if (!is_read) free(picture->rgb), picture->rgb = NULL;
    png_image_free(&image);
    return is_read;
}

/* Reads an EXR as the PNG beside it would show it. */
static bool read_exr(const char *path, small *picture)
{
    double exposure = 0;
    uint32_t tonemap = EC_TONEMAP_NEUTRAL;
    float *rgb = NULL;
    ec_error ignored;
    char *curve = ec_exr_header_text(path, "eclat.png.tonemap");
    ec_exr_number(path, "eclat.png.exposure", &exposure);
    if (curve) ec_parse_choice("tonemap", curve, ec_tonemap_names, &tonemap, &ignored);
    free(curve);
    if (ec_image_read_rgb(path, &picture->width, &picture->height, &rgb, &ignored) != EC_OK) return false;
    const uint64_t pixels = (uint64_t)picture->width * picture->height;
    picture->rgb = malloc(3 * pixels);
    if (picture->rgb) ec_tonemap_rgb(rgb, picture->rgb, pixels, (float)exposure, (ec_tonemap)tonemap);
    free(rgb);
    return picture->rgb;
}

/* Averages the light in the part of a picture that a pixel covers. */
static void mean_of(const small *from, uint32_t width, uint32_t height, uint32_t x, uint32_t y, float mean[3])
{
    const uint64_t x0 = (uint64_t)x * from->width / width, x1 = (uint64_t)(x + 1) * from->width / width;
    const uint64_t y0 = (uint64_t)y * from->height / height, y1 = (uint64_t)(y + 1) * from->height / height;
    const double *linear = ec_srgb_bytes();
    double sum[3] = {0};
    for (uint64_t v = y0; v < y1; v++)
        for (uint64_t u = x0; u < x1; u++)
            for (uint64_t c = 0; c < 3; c++) sum[c] += linear[from->rgb[3 * (v * from->width + u) + c]];
    for (int c = 0; c < 3; c++) mean[c] = (float)(sum[c] / (double)((x1 - x0) * (y1 - y0)));
}

/* Shrinks a picture to a cell's size, if it is larger; drops it if there is no memory. */
static void shrink(small *picture)
{
    const double scale = fmin(1, (double)CELL / fmax(picture->width, picture->height));
    small less = {(uint32_t)fmax(1, floor(scale * picture->width)), (uint32_t)fmax(1, floor(scale * picture->height)), NULL};
    less.rgb = malloc(3 * (uint64_t)less.width * less.height);
    for (uint32_t y = 0; less.rgb && y < less.height; y++)
        for (uint32_t x = 0; x < less.width; x++) {
            float mean[3];
            mean_of(picture, less.width, less.height, x, y, mean);
            ec_tonemap_rgb(mean, less.rgb + 3 * ((uint64_t)y * less.width + x), 1, 0, EC_TONEMAP_NONE);
        }
    free(picture->rgb);
    *picture = less;
}

/* Draws a file's name, without its folder and ending. */
static void draw_name(const char *file, uint32_t x, uint32_t y, uint32_t width, uint8_t *sheet, uint64_t stride)
{
    char name[256];
    const char *slash = strrchr(file, '/');
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : file);
    char *dot = strrchr(name, '.');
    if (dot) *dot = 0;
    ec_label_draw(name, x, y, width, INK, sheet, stride);
}

/* Places the pictures in cells as large as the largest one, each centred, with its name below. */
static ec_result write(const char *path, const small *pictures, char *const *files, uint32_t count, ec_error *err)
{
    const uint32_t line = ec_label_height();
    uint32_t wide = 1, high = 1;
    for (uint32_t i = 0; i < count; i++) {
        if (pictures[i].width > wide) wide = pictures[i].width;
        if (pictures[i].height > high) high = pictures[i].height;
    }
    const uint32_t across = (uint32_t)fmax(1, fmin(count, ceil(sqrt(1.5 * count * high / wide)))), down = count ? (count + across - 1) / across : 1;
    const uint64_t width = GAP + (uint64_t)across * (wide + GAP), height = GAP + (uint64_t)down * (high + line + GAP);
    if (width > SIDE_MOST || height > SIDE_MOST) return ec_fail(err, "cannot write '%s': %u pictures are too many for one sheet; make several with --shard", path, count);
    uint8_t *sheet = malloc(3 * width * height);
    if (!sheet) return ec_fail(err, "cannot write '%s': out of memory for %u pictures", path, count);
    memset(sheet, GROUND, 3 * width * height);
    for (uint32_t i = 0; i < count; i++) {
        const small *p = &pictures[i];
        const uint64_t left = GAP + i % across * (wide + GAP) + (wide - p->width) / 2, row = GAP + i / across * (high + line + GAP), top = row + (high - p->height) / 2;
        for (uint32_t y = 0; p->rgb && y < p->height; y++)
            memcpy(sheet + 3 * ((top + y) * width + left), p->rgb + 3 * (uint64_t)y * p->width, 3 * (size_t)p->width);
        draw_name(files[i], GAP + i % across * (wide + GAP), (uint32_t)row + high, wide, sheet, width);
    }
    ec_result result = ec_png_write(path, (uint32_t)width, (uint32_t)height, sheet, err);
    free(sheet);
    return result;
}

ec_result ec_sheet_write(const char *path, char *const *files, uint32_t count, ec_error *err)
{
    small *pictures = calloc(count + 1, sizeof *pictures);
    if (!pictures) return ec_fail(err, "cannot write '%s': out of memory for %u pictures", path, count);
    for (uint32_t i = 0; i < count; i++) {
        const char *dot = strrchr(files[i], '.');
        const bool is_png = dot && !strcasecmp(dot, ".png");
        if (is_png ? read_png(files[i], &pictures[i]) : read_exr(files[i], &pictures[i])) shrink(&pictures[i]);
        else pictures[i] = (small){0};
    }
    ec_result result = write(path, pictures, files, count, err);
    for (uint32_t i = 0; i < count; i++) free(pictures[i].rgb);
    free(pictures);
    return result;
}
