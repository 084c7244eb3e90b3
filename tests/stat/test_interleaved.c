/* tier: quick */
/* Trees larger than the caches are traversed by interleaved rays, and camera rays eight at a time. Bits stay the same, also where each ray
 * has a random number of its own for partial coverage. */
#include "accel/accel.h"
#include "device/stages.h"
#include "support/render_case.h"

static ec_render_options options(void)
{
    ec_render_options o = case_quick(case_options(160, 96, 4));
    o.accel = "bvh8";
    return o;
}

static bool is_interleaved(const case_image *image)
{
    return strstr(ec_traversal_of(&case_cl()->info, ec_accel_find("bvh8"), 1000, image->stats.effects.built, 1).options, "INTERLEAVE") != NULL;
}

/* A cache of hundreds of megabytes is shared by many cores, and slow. */
static void large_bvhs_are_told_by_what_is_fast(void)
{
    const uint64_t MIB = 1 << 20;
    const struct { uint64_t cache, bytes; bool interleaved; } cases[] = {
        {32 * MIB, 3 * MIB, false}, {32 * MIB, 5 * MIB, true}, {300 * MIB, 3 * MIB, false}, {300 * MIB, 5 * MIB, true}, {8 * MIB, 2 * MIB, true},
    };
    ec_device_info info = {.type = CL_DEVICE_TYPE_CPU};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        info.cache_bytes = cases[i].cache;
        CHECK(!strstr(ec_traversal_of(&info, ec_accel_find("bvh8"), cases[i].bytes, 0, 1).options, "INTERLEAVE") == !cases[i].interleaved);
    }
}

/* A work-item takes 16 or 64 rays of one of the queue's 32 parts. Here each part has room for 37, or for 301. */
static void parts_of_any_size_are_traced_to_their_end(const ec_scene *scene, const case_image *expected)
{
    const uint64_t cache = case_cl()->info.cache_bytes, caches[] = {UINT64_C(1) << 30, 0};
    const uint32_t parts[] = {37, 301};
    for (int i = 0; i < 4; i++) {
        ec_render_options o = options();
        o.lanes = 1;
        o.wave = 32 * parts[i / 2];
        case_cl()->info.cache_bytes = caches[i % 2];
        case_image image = case_render(scene, &o);
        CHECK(image.stats.wave == o.wave);
        CHECK(case_same_bits(&image.film, &expected->film));
        case_free(&image);
    }
    case_cl()->info.cache_bytes = cache;
}

int main(void)
{
    large_bvhs_are_told_by_what_is_fast();
    const ec_render_options o = options();
    ec_scene *scene = case_load(OWN_SCENE("toy/toy.gltf"), "1,1,1");
    case_image opaque = case_render(scene, &o);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        scene->materials[i].alpha_mode = EC_ALPHA_BLEND;
        scene->materials[i].base_color[3] = 0.5f;
    }
    case_image expected = case_render(scene, &o);
    CHECK(!is_interleaved(&expected));
    CHECK(expected.stats.effects.called.bits & EC_FEATURE_ALPHA);
    CHECK(!case_same_bits(&opaque.film, &expected.film));
    case_cl()->info.cache_bytes = 0;
    case_image image = case_render(scene, &o);
    if (case_cl()->info.type & CL_DEVICE_TYPE_CPU) CHECK(is_interleaved(&image));
    CHECK(case_same_bits(&image.film, &expected.film));
    parts_of_any_size_are_traced_to_their_end(scene, &expected);
    case_free(&opaque);
    case_free(&expected);
    case_free(&image);
    ec_scene_free(scene);
    TEST_END();
}
