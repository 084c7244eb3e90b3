/* tier: quick */
/* OpenEXR files of other programs: every compression, pixel type and storage that eclat reads, and refusals of others. */
#include <OpenEXR/openexr.h>
#include <stdint.h>

#include "image/exr_header.h"
#include "image/image.h"
#include "support/test.h"

static ec_error err;

/* A file as another program might write it: a window that does not begin at (0, 0), three pixel types, scan lines or tiles. */
typedef struct foreign {
    exr_compression_t compression;
    exr_storage_t storage;
} foreign;

enum { FW = 40, FH = 56, TILE_W = 16, TILE_H = 24 }; /* tiles cut at both edges; no smaller than B44's 4 x 4 */

static float foreign_value(int channel, int x, int y) { return (float)((x * 3 + y * 5) % 64 + 64 * channel); }

static void point_encoder(exr_encode_pipeline_t *block, const exr_chunk_info_t *info, int x0, int y0, float *scratch)
{
    for (int c = 0; c < block->channel_count; c++) {
        float *to = scratch + c * FW * FH;
        exr_coding_channel_info_t *channel = &block->channels[c];
        for (int y = 0; y < info->height; y++)
            for (int x = 0; x < info->width; x++) {
                float value = foreign_value(c, x0 + x, y0 + y);
                uint32_t whole = (uint32_t)value;
                memcpy(to + y * info->width + x, channel->data_type == EXR_PIXEL_UINT ? (void *)&whole : (void *)&value, 4);
            }
        channel->user_data_type = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 4;
        channel->user_line_stride = 4 * info->width;
        channel->encode_from_ptr = (const uint8_t *)to;
    }
}

static exr_result_t encode(exr_context_t file, const exr_chunk_info_t *info, int x0, int y0)
{
    static float scratch[3 * FW * FH];
    exr_encode_pipeline_t block = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_encoding_initialize(file, 0, info, &block);
    if (!code) point_encoder(&block, info, x0, y0, scratch);
    if (!code) code = exr_encoding_choose_default_routines(file, 0, &block);
    if (!code) code = exr_encoding_run(file, 0, &block);
    exr_encoding_destroy(file, &block);
    return code;
}

static exr_result_t write_foreign(const char *path, foreign kind)
{
    exr_context_t file = NULL;
    int part = 0, lines = 1;
    const exr_attr_box2i_t window = {.min = {.x = -5, .y = 7}, .max = {.x = -5 + FW - 1, .y = 7 + FH - 1}};
    const exr_attr_v2f_t centre = {.x = 0, .y = 0};
    exr_result_t code = exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, NULL);
    if (!code) code = exr_add_part(file, "", kind.storage, &part);
    if (!code)
        code = exr_initialize_required_attr(file, 0, &window, &window, 1, &centre, 1, EXR_LINEORDER_INCREASING_Y,
                                            kind.compression);
    if (!code && kind.storage == EXR_STORAGE_TILED)
        code = exr_set_tile_descriptor(file, 0, TILE_W, TILE_H, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
    if (!code) code = exr_add_channel(file, 0, "A", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    if (!code) code = exr_add_channel(file, 0, "B", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!code) code = exr_add_channel(file, 0, "id", EXR_PIXEL_UINT, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    if (!code) code = exr_write_header(file);
    exr_chunk_info_t info;
    if (kind.storage == EXR_STORAGE_TILED) {
        for (int y = 0; !code && y < FH; y += TILE_H)
            for (int x = 0; !code && x < FW; x += TILE_W) {
                code = exr_write_tile_chunk_info(file, 0, x / TILE_W, y / TILE_H, 0, 0, &info);
                if (!code) code = encode(file, &info, x, y);
            }
    } else {
        if (!code) code = exr_get_scanlines_per_chunk(file, 0, &lines);
        for (int y = 0; !code && y < FH; y += lines) {
            code = exr_write_scanline_chunk_info(file, 0, 7 + y, &info);
            if (!code) code = encode(file, &info, 0, y);
        }
    }
    exr_result_t finished = exr_finish(&file);
    return code ? code : finished;
}

static void foreign_files_are_read(void)
{
    /* B44 is lossy for halves; these values have few bits, but too many for it. */
    static const struct { exr_compression_t compression; const char *name; float half_error; } kinds[] = {
        {EXR_COMPRESSION_NONE, "none", 0}, {EXR_COMPRESSION_RLE, "rle", 0},     {EXR_COMPRESSION_ZIPS, "zips", 0},
        {EXR_COMPRESSION_ZIP, "zip", 0},   {EXR_COMPRESSION_PIZ, "piz", 0},     {EXR_COMPRESSION_PXR24, "pxr24", 0},
        {EXR_COMPRESSION_B44, "b44", 3},   {EXR_COMPRESSION_B44A, "b44a", 3}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int tiled = 0; tiled < 2; tiled++) {
            char path[512];
            snprintf(path, sizeof path, "%s/foreign-%s-%s.exr", ECLAT_TEST_OUT, kinds[k].name, tiled ? "tiled" : "lines");
            exr_result_t code =
                write_foreign(path, (foreign){kinds[k].compression, tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE});
            CHECK_MSG(code == EXR_ERR_SUCCESS, "writing %s: %s", path, exr_get_default_error_message(code));
            ec_exr exr;
            CHECK_OK(ec_exr_read(path, &exr, &err), err);
            CHECK(exr.width == FW && exr.height == FH && exr.channel_count == 3);
            float worst[3] = {0};
            for (int c = 0; c < 3 && exr.channel_count == 3; c++)
                for (int i = 0; i < FW * FH; i++)
                    worst[c] = fmaxf(worst[c], fabsf(exr.planes[c][i] - foreign_value(c, i % FW, i / FW)));
            CHECK_MSG(worst[0] <= kinds[k].half_error && worst[1] == 0 && worst[2] == 0, "%s: off by %g %g %g", path,
                      worst[0], worst[1], worst[2]);
            for (int c = 0; c < 3; c++) { /* only one of them */
                static const char *const names[3] = {"A", "B", "id"};
                ec_exr one;
                CHECK_OK(ec_exr_read_some(path, (const char *const[]){names[c], "none", NULL}, &one, &err), err);
                CHECK(one.channel_count == 3 && !memcmp(ec_exr_plane(&one, names[c]), exr.planes[c], sizeof(float) * FW * FH));
                CHECK(!ec_exr_plane(&one, names[(c + 1) % 3]) && !ec_exr_plane(&one, names[(c + 2) % 3]) && !ec_exr_plane(&one, "none"));
                ec_exr_free(&one);
            }
            ec_exr_free(&exr);
            double number = 0;
            CHECK(ec_exr_is_half(path, "A") && !ec_exr_is_half(path, "B") && !ec_exr_is_half(path, "none"));
            CHECK(ec_exr_number(path, "pixelAspectRatio", &number) && number == 1);
            CHECK(!ec_exr_number(path, "compression", &number) && !ec_exr_number(path, "none", &number));
            remove(path);
            CHECK(!ec_exr_number(path, "pixelAspectRatio", &number) && !ec_exr_is_half(path, "A"));
        }
}

static void put(FILE *file, const char *name, const char *type, const void *value, int32_t size)
{
    fwrite(name, 1, strlen(name) + 1, file);
    fwrite(type, 1, strlen(type) + 1, file);
    fwrite(&size, 4, 1, file);
    fwrite(value, 1, (size_t)size, file);
}

/* A header made by hand, after "OpenEXR File Layout"; little-endian. One channel with the given sampling; flat or deep. */
static void write_header_only(const char *path, int flat, int sampling)
{
    const int32_t magic = 20000630, version = flat ? 2 : 2 | 0x800, window[4] = {0, 0, 3, 3}, one = 1, four = 4;
    const float zero[2] = {0}, unit = 1;
    const char none = 0;
    unsigned char list[19] = {'Y', 0};
    memcpy(list + 2, (const int32_t[]){2, 0, sampling, sampling}, 16);
    FILE *file = fopen(path, "wb");
    fwrite(&magic, 4, 1, file);
    fwrite(&version, 4, 1, file);
    put(file, "channels", "chlist", list, sizeof list);
    put(file, "compression", "compression", &none, 1);
    put(file, "dataWindow", "box2i", window, 16);
    put(file, "displayWindow", "box2i", window, 16);
    put(file, "lineOrder", "lineOrder", &none, 1);
    put(file, "pixelAspectRatio", "float", &unit, 4);
    put(file, "screenWindowCenter", "v2f", zero, 8);
    put(file, "screenWindowWidth", "float", &unit, 4);
    if (!flat) put(file, "type", "string", "deepscanline", 12);
    if (!flat) put(file, "name", "string", "x", 1);
    if (!flat) put(file, "version", "int", &one, 4);
    if (!flat) put(file, "chunkCount", "int", &four, 4);
    fputc(0, file);
    for (int i = 0; i < 64; i++) fputc(i, file);
    fclose(file);
}

static void files_we_cannot_use_are_named(void)
{
    const char *out = ECLAT_TEST_OUT "/header-only.exr";
    CHECK(ec_exr_read(ECLAT_TEST_OUT "/no-such.exr", &(ec_exr){0}, &err) == EC_FAILED && strstr(err.text, "no-such.exr"));
    CHECK(ec_exr_read(ECLAT_TEST_OUT, &(ec_exr){0}, &err) == EC_FAILED);

    write_header_only(out, 1, 2);
    CHECK(ec_exr_read(out, &(ec_exr){0}, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "subsampled") != NULL, "%s", err.text);
    write_header_only(out, 0, 1);
    CHECK(ec_exr_read(out, &(ec_exr){0}, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "deep") != NULL, "%s", err.text);
    remove(out);
}

/* Values printed by another reader (PyPI OpenEXR 3.5.3). */
static void shared_files_have_their_values(void)
{
    static const struct { const char *path; uint32_t width, height, x, y; float rgb[3]; } rows[] = {
        {"/assets/exr/openexr-images/TestImages/BrightRings.exr", 800, 800, 600, 40,
         {0.5f, 1025.0f, 0.5f}},
        {"/assets/exr/openexr-images/TestImages/WideColorGamut.exr", 800, 800, 136, 763,
         {-0.77734375f, -0.53515625f, 21.4375f}},
        {"/assets/exr/openexr-images/TestImages/GammaChart.exr", 800, 800, 0, 1,
         {1.0f, 0.0f, 0.0f}},
        {"/assets/exr/openexr-images/TestImages/AllHalfValues.exr", 256, 256, 225, 112,
         {9992.0f, 9992.0f, 9992.0f}},
        {"/assets/env/blender-studiolights/interior.exr", 1024, 512, 465, 109,
         {1736.0f, 1231.0f, 558.5f}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s%s", ECLAT_SHARED, rows[i].path);
        FILE *file = fopen(path, "rb");
        if (!file) continue;
        fclose(file);
        uint32_t width = 0, height = 0;
        float *rgb = NULL;
        CHECK_OK(ec_image_read_rgb(path, &width, &height, &rgb, &err), err);
        CHECK(width == rows[i].width && height == rows[i].height);
        for (int c = 0; rgb && c < 3; c++) CHECK_NEAR(rgb[3 * (rows[i].y * width + rows[i].x) + c], rows[i].rgb[c], 1e-7);
        free(rgb);
    }
}

int main(void)
{
    foreign_files_are_read();
    files_we_cannot_use_are_named();
    shared_files_have_their_values();
    TEST_END();
}
