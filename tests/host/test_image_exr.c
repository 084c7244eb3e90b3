/* tier: quick */
/* OpenEXR written and read again: the bits are equal, and the file has the attributes. */
#include <OpenEXR/openexr.h>
#include <stdint.h>

#include "image/image.h"
#include "support/test.h"

static const char *const out = ECLAT_TEST_OUT "/image.exr";
static ec_error err;

/* Values whose bits must be kept. */
static float bits(uint32_t i)
{
    static const uint32_t special[] = {0x7fc12345, 0xff800000, 0x7f800000, 0x80000000, 0x00000001, 0x7f7fffff, 0x3f800001};
    uint32_t word = i % 11 < 7 ? special[i % 11] : i * 2654435761u;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static void bits_come_back(uint32_t width, uint32_t height)
{
    uint64_t pixels = (uint64_t)width * height;
    float *interleaved = malloc(pixels * 4 * sizeof(float)), *plane = malloc(pixels * sizeof(float));
    for (uint32_t i = 0; i < 4 * pixels; i++) interleaved[i] = bits(i);
    for (uint32_t i = 0; i < pixels; i++) plane[i] = bits(i + 5);
    const ec_channel channels[] = {
        {"stderr.R", interleaved, 4}, {"R", interleaved + 1, 4}, {"depth.Z", interleaved + 2, 4},
        {"a.name.longer.than.the.31.characters.of.the.first.format", interleaved + 3, 4}, {"samples", plane, 1}};
    CHECK_OK(ec_exr_write(out, width, height, channels, 5, NULL, 0, &err), err);

    ec_exr exr;
    CHECK_OK(ec_exr_read(out, &exr, &err), err);
    CHECK(exr.width == width && exr.height == height && exr.channel_count == 5);
    for (int c = 0; c < 5; c++) {
        const float *read = ec_exr_plane(&exr, channels[c].name);
        int equal = read != NULL;
        for (uint64_t i = 0; equal && i < pixels; i++)
            equal = memcmp(read + i, channels[c].data + i * channels[c].stride, sizeof(float)) == 0;
        CHECK_MSG(equal, "%s of %u x %u", channels[c].name, width, height);
    }
    CHECK(ec_exr_plane(&exr, "G") == NULL);
    ec_exr_free(&exr);
    ec_exr_free(&exr);
    free(interleaved);
    free(plane);
}

static void attributes_stand_in_the_file(void)
{
    const float pixel = 1;
    const ec_channel channel = {"R", &pixel, 1};
    const ec_attribute attributes[] = {{"eclat.command", EC_ATTR_STRING, "eclat render 'sc\xc3\xa8ne.gltf'", 0},
                                       {"eclat.empty", EC_ATTR_STRING, "", 0},
                                       {"eclat.seed", EC_ATTR_INT, NULL, -2147483648.0},
                                       {"eclat.error", EC_ATTR_DOUBLE, NULL, 0.1},
                                       {"eclat.an.attribute.whose.name.is.long", EC_ATTR_INT, NULL, 3}};
    CHECK_OK(ec_exr_write(out, 1, 1, &channel, 1, attributes, 5, &err), err);

    exr_context_t file = NULL;
    CHECK(exr_start_read(&file, out, NULL) == EXR_ERR_SUCCESS);
    int32_t length = 0, number = 0;
    const char *text = NULL;
    double twice = 0;
    CHECK(!exr_attr_get_string(file, 0, "eclat.command", &length, &text) && strcmp(text, attributes[0].string) == 0);
    CHECK(!exr_attr_get_string(file, 0, "eclat.empty", &length, &text) && length == 0);
    CHECK(!exr_attr_get_int(file, 0, "eclat.seed", &number) && number == INT32_MIN);
    CHECK(!exr_attr_get_double(file, 0, "eclat.error", &twice) && twice == 0.1);
    CHECK(!exr_attr_get_int(file, 0, "eclat.an.attribute.whose.name.is.long", &number) && number == 3);
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    CHECK(!exr_get_compression(file, 0, &compression) && compression == EXR_COMPRESSION_ZIP);
    const exr_attr_chlist_t *list = NULL;
    CHECK(!exr_get_channels(file, 0, &list) && list->num_channels == 1 && list->entries[0].pixel_type == EXR_PIXEL_FLOAT);
    exr_finish(&file);
}

static void wrong_calls_are_refused(void)
{
    const float data[4] = {0};
    const ec_channel twice[] = {{"R", data, 1}, {"G", data, 1}, {"R", data, 1}};
    remove(out);
    CHECK(ec_exr_write(out, 2, 2, twice, 3, NULL, 0, &err) == EC_FAILED && strstr(err.text, "'R' is given twice"));
    CHECK(ec_exr_write(out, 0, 2, twice, 1, NULL, 0, &err) == EC_FAILED && strstr(err.text, "0 x 2"));
    CHECK(ec_exr_write(out, 2, 2, twice, 0, NULL, 0, &err) == EC_FAILED);
    CHECK(ec_exr_write(out, 1u << 30, 1, twice, 1, NULL, 0, &err) == EC_FAILED && strstr(err.text, "too many"));
    const ec_attribute clash = {"compression", EC_ATTR_INT, NULL, 1};
    CHECK(ec_exr_write(out, 2, 2, twice, 2, &clash, 1, &err) == EC_FAILED && strstr(err.text, "cannot write"));
    CHECK(fopen(out, "rb") == NULL);
}

int main(void)
{
    bits_come_back(1, 1);
    bits_come_back(37, 41);
    bits_come_back(16, 16);
    bits_come_back(300, 2);
    attributes_stand_in_the_file();
    wrong_calls_are_refused();
    remove(out);
    TEST_END();
}
