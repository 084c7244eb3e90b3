/* tier: quick */
/* Pictures are decoded into the memory that kernels read: packing does not copy them, gives equal bytes where it must copy, and keeps them
 * when the scene frees them. */
#include "gltf/reader.h"
#include "pack/pack.h"
#include "scene/texels.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static ec_scene *load(void)
{
    ec_scene *scene = NULL;
    const ec_log log = {0};
    ec_error err;
    CHECK_OK(ec_scene_load(ECLAT_SOURCE_DIR "/scenes/lamps/lamps.gltf", &scene, &log, &err), err);
    return scene;
}

static ec_pack pack_of(const ec_scene *scene)
{
    ec_pack pack = {0};
    ec_error err;
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    CHECK_OK(ec_pack_texels(&pack, &err), err);
    return pack;
}

static void stand_alone(ec_image *image)
{
    const size_t bytes = 4 * (size_t)image->width * image->height;
    uint8_t *own = malloc(bytes);
    if (!own) exit(1);
    memcpy(own, image->rgba8, bytes);
    ec_texels_leave(image->texels);
    image->texels = NULL;
    image->rgba8 = own;
}

int main(void)
{
    ec_scene *scene = load();
    CHECK(scene->image_count > 3 && scene->images[0].texels);
    ec_pack common = pack_of(scene);
    CHECK(common.texels == scene->images[0].texels && common.texels->count == common.texel_words);

    ec_scene *other = load();
    stand_alone(&other->images[1]);
    ec_pack copied = pack_of(other);
    CHECK(copied.texels != other->images[0].texels && copied.texel_words == common.texel_words);
    ec_scene_free(other);

    ec_scene_drop_data(scene);
    CHECK(!scene->images[0].rgba8 && !scene->images[0].texels);
    CHECK(!memcmp(common.texels->words, copied.texels->words, 4 * (common.texel_words + 1))); /* includes the zero after them */
    ec_scene_free(scene);
    ec_pack_free(&common);
    ec_pack_free(&copied);
    TEST_END();
}
