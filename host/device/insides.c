#include "device/insides.h"

#include <stdlib.h>
#include <string.h>

/* Numbers the materials that bound bodies, EC_NO_ID for the others; returns how many there are. */
static uint32_t number_bodies(const ec_pack *pack, uint32_t *number)
{
    const ec_scene *plain = &pack->plain.scene;
    uint32_t count = 0;
    for (uint32_t m = 0; m < plain->material_count; m++) number[m] = ec_pack_is_body(&plain->materials[m]) ? count++ : EC_NO_ID;
    return count;
}

static void copy_triangles(const ec_scene *from, const uint32_t *number, ec_scene *to)
{
    for (uint32_t t = 0; t < from->triangle_count; t++) {
        uint32_t n = number[from->triangle_material[t]], at = to->triangle_count;
        if (n == EC_NO_ID) continue;
        for (uint32_t k = 0; k < 3; k++) {
            to->indices[3 * (size_t)at + k] = 3 * at + k;
            memcpy(to->positions + 9 * (size_t)at + 3 * k,
                   from->positions + 3 * (size_t)from->indices[3 * (size_t)t + k], 3 * sizeof(float));
        }
        to->triangle_material[at] = n;
        to->triangle_count++;
    }
}

static ec_result fill(const ec_pack *pack, uint32_t *number, ec_insides *insides, ec_error *err)
{
    const ec_scene *plain = &pack->plain.scene;
    ec_scene *bodies = &insides->bodies;
    size_t triangles = 1;
    bodies->material_count = number_bodies(pack, number);
    for (uint32_t t = 0; t < plain->triangle_count; t++) triangles += number[plain->triangle_material[t]] != EC_NO_ID;
    insides->medium = malloc((bodies->material_count + 1) * sizeof *insides->medium);
    bodies->positions = malloc(triangles * 9 * sizeof(float));
    bodies->indices = malloc(triangles * 3 * sizeof(uint32_t));
    bodies->triangle_material = malloc(triangles * sizeof(uint32_t));
    if (!insides->medium || !bodies->positions || !bodies->indices || !bodies->triangle_material)
        return ec_fail(err, "out of memory for bodies of %zu triangles", triangles);
    for (uint32_t m = 0; m < plain->material_count; m++)
        if (number[m] != EC_NO_ID) insides->medium[number[m]] = insides->nested ? pack->materials[m].body : m * EC_MATERIAL_WORDS;
    copy_triangles(plain, number, bodies);
    return EC_OK;
}

ec_result ec_insides_make(const ec_pack *pack, uint64_t called, ec_insides *insides, ec_error *err)
{
    *insides = (ec_insides){.nested = pack->bodies.count > 0};
    if (!(called & EC_FEATURES_MEDIUM)) return EC_OK;
    uint32_t *number = malloc((pack->plain.scene.material_count + 1) * sizeof *number);
    ec_result result = number ? fill(pack, number, insides, err) : ec_fail(err, "out of memory for materials");
    free(number);
    return result;
}

void ec_insides_free(ec_insides *insides)
{
    free(insides->bodies.positions);
    free(insides->bodies.indices);
    free(insides->bodies.triangle_material);
    free(insides->medium);
    *insides = (ec_insides){0};
}

uint32_t ec_insides_of(const ec_insides *insides, const ec_camera *camera)
{
    uint32_t medium = insides->nested ? 0 : EC_NO_ID;
    if (camera->type == EC_CAMERA_ORTHOGRAPHIC) return medium;
    for (uint32_t m = 0; m < insides->bodies.material_count; m++)
        if (ec_bodies_contain(&insides->bodies, m, camera->position))
            medium = insides->nested ? medium | insides->medium[m] : insides->medium[m];
    return medium;
}
