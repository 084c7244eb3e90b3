/* tier: quick */
/* Damaged pictures: cut anywhere, or with a few flipped bits. The result must be a picture of a sane size, or one line that names the file.
 * The sanitizers check eclat's code; a crash in a library would end the test. */
#include <stdint.h>

#include "image/image.h"
#include "support/test.h"

enum { ROUNDS = 120, SIZE_MAX_BYTES = 1 << 18 };

static const char *const path = ECLAT_TEST_OUT "/garbage";
static ec_error err;
static unsigned char original[SIZE_MAX_BYTES], damaged[SIZE_MAX_BYTES];

static uint32_t seed;
static uint32_t next_random(uint32_t limit)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(seed ^ seed >> 15) * limit >> 32);
}

static size_t load(const char *name)
{
    FILE *file = fopen(name, "rb");
    if (!file) return 0;
    size_t size = fread(original, 1, sizeof original, file);
    fclose(file);
    return size;
}

static void read_and_judge(size_t size)
{
    FILE *file = fopen(path, "wb");
    if (size) fwrite(damaged, 1, size, file);
    fclose(file);
    uint32_t width = 0, height = 0;
    float *rgb = NULL;
    err.text[0] = 0;
    if (ec_image_read_rgb(path, &width, &height, &rgb, &err) == EC_OK)
        CHECK(rgb && width > 0 && height > 0);
    else
        CHECK_MSG(rgb == NULL && strstr(err.text, path) && !strchr(err.text, '\n'), "%s", err.text);
    free(rgb);
}

static void damage(const char *name)
{
    size_t size = load(name);
    if (size == 0) return;
    for (int i = 0; i < ROUNDS; i++) {
        seed = (uint32_t)i * 7919u;
        memcpy(damaged, original, size);
        if (i % 3 == 0) {
            read_and_judge(next_random((uint32_t)size));
            continue;
        }
        /* Damage to headers matters most: two rounds in three, half of them within the first 400 bytes. */
        uint32_t range = i % 3 == 1 && size > 400 ? 400 : (uint32_t)size;
        for (uint32_t flips = 1 + next_random(6); flips > 0; flips--) damaged[next_random(range)] ^= 1u << next_random(8);
        read_and_judge(size);
    }
}

/* A file of eclat's own, small enough to cut it at every byte: each cut must be an error. */
static void no_cut_picture_is_taken_for_whole(void)
{
    float data[3 * 20 * 20];
    for (int i = 0; i < 3 * 20 * 20; i++) data[i] = (float)(i % 17) * 0.5f;
    const ec_channel channels[] = {{"R", data, 3}, {"G", data + 1, 3}, {"B", data + 2, 3}};
    CHECK_OK(ec_exr_write(path, 20, 20, channels, 3, NULL, 0, &err), err);
    size_t size = load(path);
    memcpy(damaged, original, size);
    CHECK(size > 300);
    for (size_t cut = 0; cut < size; cut++) {
        FILE *file = fopen(path, "wb");
        if (cut) fwrite(damaged, 1, cut, file);
        fclose(file);
        ec_exr exr;
        CHECK_MSG(ec_exr_read(path, &exr, &err) == EC_FAILED && exr.planes == NULL, "%zu of %zu bytes", cut, size);
    }
}

/* A killed writer leaves blocks and a table of zeros: such a file is not a picture. */
static void an_unfinished_picture_is_refused(void)
{
    const float data[20 * 20] = {1};
    const ec_channel channel = {"R", data, 1};
    CHECK_OK(ec_exr_write(path, 20, 20, &channel, 1, NULL, 0, &err), err);
    size_t size = load(path), table = 0;
    for (uint64_t at = 0, first; at + 16 < size && !table; at++) /* two blocks: the first starts after two offsets */
        if (memcpy(&first, original + at, 8), first == at + 16) table = at;
    CHECK(table > 0);
    memset(original + table, 0, 16);
    FILE *file = fopen(path, "wb");
    fwrite(original, 1, size, file);
    fclose(file);
    ec_exr exr;
    CHECK(ec_exr_read(path, &exr, &err) == EC_FAILED && strstr(err.text, "damaged"));
}

int main(void)
{
    an_unfinished_picture_is_refused();
    no_cut_picture_is_taken_for_whole();
    damage(ECLAT_SHARED "/assets/exr/openexr-images/TestImages/GammaChart.exr");
    damage(ECLAT_SHARED "/assets/exr/openexr-images/TestImages/AllHalfValues.exr");
    damage(ECLAT_SHARED "/assets/env/blender-studiolights/interior.exr");
    damage(ECLAT_SHARED "/assets/env/nvpro/env3.hdr");
    remove(path);
    TEST_END();
}
