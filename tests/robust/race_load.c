/* Decodes pictures and computes an environment map's table with several threads under ThreadSanitizer (test_races.py). With an argument it
 * makes a race of its own, which must be found. */
#include <omp.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pack/pack.h"
#include "gltf/flatten.h"

enum { PICTURES = 16, THREADS = 4, SIDE = 256, WIDTH = 300, HEIGHT = 150 };

/* Large enough that no thread decodes all pictures before the others wake. Neighbouring bytes differ. */
static unsigned char *make_png(png_size_t *size)
{
    static unsigned char rgb[3 * SIDE * SIDE], file[sizeof rgb + 65536];
    uint32_t noise = 1;
    for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (unsigned char)((noise = noise * 1664525u + 1013904223u) >> 24);
    png_image image = {.version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE, .format = PNG_FORMAT_RGB};
    *size = sizeof file;
    if (!png_image_write_to_memory(&image, file, size, 0, rgb, 0, NULL)) *size = 0;
    return file;
}

static int warnings;
static void count_warning(void *user, ec_severity severity, const char *text)
{
    (void)user, (void)text;
    warnings += severity == EC_WARNING;
}

/* Gives each picture a material. Every fourth picture is truncated. */
static uint32_t load(void)
{
    png_size_t size;
    ec_gltf_buffer buffer = {.data = make_png(&size)};
    ec_gltf_view views[2] = {{.length = size}, {.length = size / 2}};
    buffer.length = size;
    ec_gltf_image images[PICTURES];
    ec_gltf_texture textures[PICTURES];
    ec_gltf_primitive primitives[PICTURES];
    ec_material materials[PICTURES];
    memset(images, 0, sizeof images);
    memset(textures, 0, sizeof textures);
    memset(primitives, 0, sizeof primitives);
    memset(materials, 0, sizeof materials);
    for (int i = 0; i < PICTURES; i++) {
        images[i].view = i % 4 == 3;
        textures[i].image = i;
        primitives[i].drawn = true;
        primitives[i].scene_material = (uint32_t)i;
        for (int k = 0; k < EC_SLOT_COUNT; k++) materials[i].textures[k].texture = k ? -1 : i;
    }
    ec_gltf_mesh mesh = {.primitives = primitives, .primitive_count = PICTURES};
    ec_gltf g = {.path = "race", .folder = "", .buffers = &buffer, .buffer_count = 1, .views = views, .view_count = 2, .images = images,
                 .image_count = PICTURES, .textures = textures, .texture_count = PICTURES, .meshes = &mesh, .mesh_count = 1};
    ec_placement place = {.mesh = 0};
    ec_placement_list places = {.items = &place, .count = 1};
    ec_scene s = {.materials = materials, .material_count = PICTURES};
    const ec_log log = {count_warning, NULL};
    ec_error err;
    if (ec_gltf_textures_load(&g, &places, &s, &log, &err) != EC_OK) fprintf(stderr, "%s\n", err.text);
    uint32_t loaded = s.image_count;
    for (uint32_t i = 0; i < loaded; i++) ec_image_free(&s.images[i]);
    free(s.images);
    free(s.textures);
    return loaded;
}

/* Adds up the densities by which a map is sampled. */
static double weigh(void)
{
    static float rgb[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) rgb[i] = (float)(i % 97);
    const ec_environment map = {.width = WIDTH, .height = HEIGHT, .rgb = rgb};
    ec_packed_map packed;
    ec_error err;
    double sum = 0;
    if (ec_pack_map(&map, &packed, &err) != EC_OK) fprintf(stderr, "%s\n", err.text);
    for (int i = 0; packed.texels && i < WIDTH * HEIGHT; i++) sum += packed.texels[4 * i + 3];
    ec_packed_map_free(&packed);
    return sum;
}

static void race(void)
{
    volatile int shared = 0;
#pragma omp parallel for num_threads(THREADS)
    for (int i = 0; i < 100000; i++) shared++;
    printf("%d\n", shared);
}

int main(int argc, char **argv)
{
    (void)argv;
    omp_set_num_threads(THREADS);
    if (argc > 1) race();
    uint32_t loaded = load();
    const double by_all = weigh();
    omp_set_num_threads(1);
    printf("%u of %d pictures by %d threads, %d warnings, densities %s\n", loaded, PICTURES, THREADS, warnings,
           by_all > 0 && by_all == weigh() ? "as by one thread" : "differ from one thread's");
    return 0;
}
