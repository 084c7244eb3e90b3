/* tier: full */
/* Every allocation of eclat's own fails in turn while a scene is read, packed and built. Each time there is an error of one line, and
 * nothing is left half made (the sanitizers report at the end). With memory again, the result is as before. The linker redirects malloc and
 * the like in eclat's objects to this file (--wrap, CMakeLists.txt); libraries' calls are not tested. */
#include <malloc.h>
#include <stdatomic.h>

#include "accel/follow.h"
#include "pack/pack.h"
#include "test_scene_files.h"
#include "gltf/reader.h"

static atomic_long calls, failing; /* failing: number of the failing call; 0: none */
static bool tells;                 /* prints the place of the failure */

void __sanitizer_print_stack_trace(void) __attribute__((weak)); /* ECLAT_SANITIZE=OFF has none */

static bool fails(void)
{
    if (atomic_fetch_add(&calls, 1) + 1 != atomic_load(&failing)) return false;
    if (tells && __sanitizer_print_stack_trace) __sanitizer_print_stack_trace();
    return true;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
char *__real_strdup(const char *text);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
char *__wrap_strdup(const char *text);
void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *old, size_t size) /* shrinking needs no new memory */
{
    bool grows = !old || malloc_usable_size(old) < size;
    return grows && fails() ? NULL : __real_realloc(old, size);
}
void *__wrap_aligned_alloc(size_t alignment, size_t size) { return fails() ? NULL : __real_aligned_alloc(alignment, size); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : __real_strdup(text); }

static ec_result build_all(const ec_scene *scene, ec_error *err)
{
    ec_accel_input input = {.positions = scene->positions, .indices = scene->indices, .threads = 1, .whole = scene->whole,
                            .triangle_count = ec_scene_flat_count(scene), .shape_count = scene->shape_count,
                            .placed_count = scene->placed_count, .shapes = scene->shapes, .placed = scene->placed};
    ec_result result = EC_OK;
    for (uint32_t which = 0; result == EC_OK && which < EC_ACCEL_COUNT; which++) {
        ec_accel accel;
        result = ec_accel_build(which, &input, &accel, err);
        ec_accel_free(&accel);
    }
    ec_accel_input_free(&input);
    return result;
}

static ec_result pack_all(const ec_scene *scene, ec_error *err)
{
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    ec_result result = ec_pack_texels(&pack, err);
    if (result == EC_OK && pack.light_count) result = ec_pack_light_tree(&pack, err);
    if (result == EC_OK) result = ec_pack_light_centres(scene, &pack, err);
    ec_pack_free(&pack);
    return result;
}

typedef struct input {
    const char *path, *map;
    bool animated, frames;
} input;

/* Loads two moments of one document, and updates structures from one to the other. */
static ec_result show(ec_animation *animation, double at, ec_followed *followed, ec_error *err)
{
    ec_scene *scene;
    const ec_scene_choice choice = {.at = at, .animated = true, .frame = true};
    EC_TRY(ec_animation_show(animation, &choice, &scene, NULL, err));
    ec_accel_input in = {.positions = scene->positions, .indices = scene->indices, .triangle_count = scene->triangle_count,
                         .vertex_count = scene->vertex_count, .whole = scene->whole, .threads = 1};
    ec_result result = pack_all(scene, err);
    if (result == EC_OK) result = ec_accels_follow(followed, &in, 1u << ec_accel_find("bvh2") | 1u << ec_accel_find("bvh8"), err);
    ec_accel_input_free(&in);
    ec_scene_free(scene);
    return result;
}

static ec_result all_frames(const input *in, ec_error *err)
{
    ec_animation *animation;
    ec_followed followed = {0};
    const ec_scene_choice choice = {.at = 0.2, .animated = true, .frame = true};
    ec_result result = ec_animation_open(in->path, &choice, &animation, NULL, err);
    if (result != EC_OK) CHECK(!animation);
    for (int k = 0; k < 3 && result == EC_OK; k++) result = show(animation, 0.2 + 0.2 * k, &followed, err);
    ec_followed_free(&followed);
    ec_animation_close(animation);
    return result;
}

static ec_result everything(const input *in, ec_error *err)
{
    ec_scene *scene, written;
    if (in->frames) return all_frames(in, err);
    ec_scene_choice choice = {.at = 0.6, .animated = in->animated, .instancing = EC_INSTANCING_ON};
    ec_result result = ec_scene_load_choice(in->path, &choice, &scene, NULL, err);
    if (result != EC_OK) CHECK(!scene);
    if (result == EC_OK) result = ec_scene_set_environment(scene, in->map, NULL, err);
    if (result == EC_OK) result = pack_all(scene, err);
    if (result == EC_OK) result = build_all(scene, err);
    if (result == EC_OK && (result = ec_scene_write_out(scene, &written, err)) == EC_OK) ec_scene_written_free(&written);
    ec_scene_free(scene);
    return result;
}

static ec_result fail_at(const input *in, long at, ec_error *err)
{
    *err = (ec_error){0};
    calls = 0;
    failing = at;
    ec_result result = everything(in, err);
    failing = 0;
    return result;
}

/* most: how many of the allocations are tried, evenly spread. */
static void sweep_as(const char *name, input in, long most)
{
    char path[512];
    ec_error err;
    in.path = path;
    snprintf(path, sizeof path, "%s/%s", ECLAT_SOURCE_DIR, name);
    fail_at(&in, 0, &err); /* allocated once by libraries and the run-time */
    CHECK_OK(fail_at(&in, 0, &err), err);
    long count = calls;
    CHECK(count > 10);
    for (long i = 0; i < count && i < most; i++) {
        long at = count <= most ? i + 1 : 1 + i * (count - 1) / (most - 1);
        tells = fail_at(&in, at, &err) == EC_OK;
        CHECK_MSG(!tells, "%s: allocation %ld of %ld failed without an error", name, at, count);
        CHECK_MSG(tells || (*err.text && !strchr(err.text, '\n')), "%s: allocation %ld: \"%s\"", name, at, err.text);
        if (tells) fail_at(&in, at, &err);
        tells = false;
    }
    CHECK_OK(fail_at(&in, 0, &err), err);
    CHECK_MSG(calls == count, "%s: %ld allocations, %ld before", name, (long)calls, count);
}

static void sweep(const char *name, const char *map, bool animated, long most) { sweep_as(name, (input){.map = map, .animated = animated}, most); }

int main(void)
{
    static const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n\x40\x40\x40\x81\x80\x40\x40\x81\x40\x80\x40\x81\x40\x40\x80\x81";
    const char *map = temp_path(".hdr");
    write_file(map, hdr, sizeof hdr - 1);
    sweep("tests/robust/corpus/gltf/seed-morph", map, true, 200);
    sweep("tests/robust/corpus/gltf/seed-skin", map, true, 200);
    sweep("tests/robust/corpus/gltf/seed-spline", map, true, 200);
    sweep_as("tests/robust/corpus/gltf/seed-morph", (input){.frames = true}, 200);
    sweep_as("tests/robust/corpus/gltf/seed-skin", (input){.frames = true}, 200);
    sweep("tests/robust/corpus/gltf/seed-variants", map, false, 200);
    sweep("tests/robust/corpus/gltf/seed-webp", map, false, 200);
    sweep("tests/robust/corpus/gltf/seed-instances", map, false, 200);
    sweep("tests/robust/corpus/gltf/seed-draco", map, false, 200);
    sweep("tests/robust/corpus/gltf/seed-meshopt", map, false, 200);
    sweep("scenes/drink/drink.gltf", map, false, 12);
    sweep("scenes/lamps/lamps.gltf", map, false, 12);
    remove(map);
    TEST_END();
}
