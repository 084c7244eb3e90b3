/* tier: quick */
/* The smallest and largest values of an image's channels, anywhere in the image. */
#include "scene/texture_range.h"
#include "support/test.h"

static void check(const ec_image *image)
{
    ec_image known = *image;
    ec_image_find_range(&known);
    CHECK(known.has_range);
    for (int c = 0; c < 4; c++) {
        uint32_t low = UINT32_MAX, high = 0, least[2], most[2];
        for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
            uint32_t v = image->rgba16 ? image->rgba16[4 * i + (size_t)c] : image->rgba8[4 * i + (size_t)c];
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
        ec_image_range(image, c, &least[0], &most[0]);
        ec_image_range(&known, c, &least[1], &most[1]);
        for (int k = 0; k < 2; k++)
            CHECK_MSG(least[k] == low && most[k] == high, "%u x %u, channel %d: %u to %u, not %u to %u", image->width, image->height, c, least[k],
                      most[k], low, high);
    }
}

/* Each texel in turn is different from all others. */
int main(void)
{
    uint8_t shallow[4 * 41];
    uint16_t deep[4 * 41];
    for (uint32_t width = 1; width <= 41; width++)
        for (uint32_t odd = 0; odd < width; odd++) {
            for (uint32_t i = 0; i < 4 * width; i++) {
                const int away = i / 4 != odd ? 0 : i % 2 ? -20 : 20;
                shallow[i] = (uint8_t)(100 + (int)(i % 4) + away);
                deep[i] = (uint16_t)(40000 + (int)(i % 4) + 500 * away);
            }
            check(&(ec_image){.width = width, .height = 1, .rgba8 = shallow});
            check(&(ec_image){.width = 1, .height = width, .rgba16 = deep});
        }
    TEST_END();
}
