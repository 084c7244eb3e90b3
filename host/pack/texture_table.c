/* Puts all images into one buffer of texels: bytes as they are (one word per texel, decoded in the kernel), deeper images as linear floats (four
 * words). A texture has one entry for each encoding in which it is read: 2 * texture + is_srgb. */
#include <string.h>

#include "base/freed.h"
#include "image/image.h"
#include "pack/pack.h"
#include "scene/texels.h"

int32_t ec_pack_texture_index(const ec_scene *scene, const ec_texture_use *use, int is_srgb)
{
    if (use->texture < 0 || (uint32_t)use->texture >= scene->texture_count) return -1;
    return 2 * use->texture + (is_srgb ? 1 : 0);
}

static size_t image_texels(const ec_image *image)
{
    return (size_t)image->width * image->height;
}

/* Writes both encodings one after the other. linear: every value of a 16-bit channel, decoded as sRGB. */
static void write_deep(const ec_image *image, const float *linear, uint32_t *words)
{
    const size_t count = 4 * image_texels(image);
    for (size_t i = 0; i < count; i++) {
        const float plain = (float)(image->rgba16[i] / 65535.0), *decoded = i % 4 == 3 ? &plain : &linear[image->rgba16[i]];
        memcpy(&words[i], &plain, sizeof plain);
        memcpy(&words[count + i], decoded, sizeof *decoded);
    }
}

/* Deep images are stored twice: as they are, and decoded from sRGB. */
static size_t image_words(const ec_image *image) { return image_texels(image) * (image->rgba16 ? 8 : 1); }

/* Tabulates 65536 powers, since an image may have millions of texels. NULL if there is no memory. */
static float *deep_to_linear(void)
{
    float *linear = malloc(65536 * sizeof *linear);
    for (int i = 0; linear && i < 65536; i++) linear[i] = (float)ec_srgb_to_linear(i / 65535.0);
    return linear;
}

/* linear: NULL if there is no deep image. */
static void write_image(const ec_image *image, const float *linear, uint32_t *words)
{
    if (image->rgba16) write_deep(image, linear, words);
    else memcpy(words, image->rgba8, 4 * image_texels(image)); /* little-endian words: R lowest */
}

/* Marks textures of materials that triangles show, in slots that the plain view has kept. */
static void find_used(const ec_scene *scene, bool *used)
{
    for (uint32_t m = 0; m < scene->material_count; m++)
        for (int k = 0; k < EC_SLOT_COUNT; k++) {
            int32_t texture = scene->materials[m].textures[k].texture;
            if (texture >= 0 && (uint32_t)texture < scene->texture_count) used[scene->textures[texture].image] = true;
        }
}

ec_result ec_pack_textures(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    for (int i = 0; i < 256; i++) pack->srgb[i] = (float)ec_srgb_bytes()[i];
    pack->texture_count = 2 * scene->texture_count;
    pack->textures = calloc(pack->texture_count ? pack->texture_count : 1, sizeof *pack->textures);
    EC_FREED size_t *offset = calloc(scene->image_count ? scene->image_count : 1, sizeof *offset);
    EC_FREED bool *used = calloc(scene->image_count ? scene->image_count : 1, sizeof *used);
    if (!pack->textures || !offset || !used) return ec_fail(err, "out of memory for %u textures", scene->texture_count);
    find_used(scene, used);
    for (uint32_t i = 0; i < scene->image_count; i++) {
        offset[i] = pack->texel_words;
        if (used[i]) pack->texel_words += image_words(&scene->images[i]);
    }
    if (pack->texel_words > UINT32_MAX)
        return ec_fail(err, "the scene's images take %.1f GiB as texels, and at most 16 GiB can be addressed; shrink them",
                       (double)pack->texel_words * 4 / (1 << 30));
    for (uint32_t t = 0; t < pack->texture_count; t++) {
        const ec_texture *texture = &scene->textures[t / 2];
        const ec_image *image = &scene->images[texture->image];
        size_t second = image->rgba16 && t % 2 ? 4 * image_texels(image) : 0;
        pack->textures[t] = (ec_texture_data){
            (uint32_t)(offset[texture->image] + second), image->width, image->height,
            (uint32_t)texture->wrap_s << EC_TEXTURE_WRAP_S | (uint32_t)texture->wrap_t << EC_TEXTURE_WRAP_T |
                (texture->nearest ? EC_TEXTURE_NEAREST : 0) | (image->rgba16 ? EC_TEXTURE_FLOAT : 0)};
    }
    return EC_OK;
}

/* Returns the texels that already hold all used pictures in the order and at the places of this pack; NULL: there are none, and pictures have to be
 * copied. */
static ec_texels *common_texels(const ec_scene *scene, const bool *used, uint64_t words)
{
    ec_texels *texels = NULL;
    uint64_t offset = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const ec_image *image = &scene->images[i];
        if (!used[i]) continue;
        if (!texels) texels = image->texels;
        if (!texels || image->texels != texels || image->rgba8 != (const uint8_t *)(texels->words + offset)) return NULL;
        offset += image_words(image);
    }
    return texels && texels->count == words ? texels : NULL;
}

static void write_texels(const ec_scene *scene, const bool *used, const float *linear, uint32_t **places, uint32_t *words)
{
    for (uint32_t i = 0; i < scene->image_count; i++) {
        places[i] = words;
        if (used[i]) words += image_words(&scene->images[i]);
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (used[i]) write_image(&scene->images[i], linear, places[i]);
}

ec_result ec_pack_texels(ec_pack *pack, ec_error *err)
{
    const ec_scene *scene = &pack->plain.scene;
    bool has_deep = false;
    EC_FREED bool *used = calloc(scene->image_count ? scene->image_count : 1, sizeof *used);
    EC_FREED uint32_t **places = calloc(scene->image_count ? scene->image_count : 1, sizeof *places);
    if (!used || !places) return ec_fail(err, "out of memory for %u pictures", scene->image_count);
    find_used(scene, used);
    ec_texels *common = common_texels(scene, used, pack->texel_words);
    if (common) {
        pack->texels = ec_texels_keep(common);
        return EC_OK;
    }
    for (uint32_t i = 0; i < scene->image_count; i++) has_deep |= scene->images[i].rgba16 != NULL;
    EC_FREED float *linear = has_deep ? deep_to_linear() : NULL;
    pack->texels = ec_texels_make(pack->texel_words);
    if (!pack->texels || (has_deep && !linear)) return ec_fail(err, "out of memory for %zu MB of texels", pack->texel_words * 4 / 1000000);
    write_texels(scene, used, linear, places, pack->texels->words);
    return EC_OK;
}
