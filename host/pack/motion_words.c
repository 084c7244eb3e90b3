/* Packs keys of what moves, as kernels/lib/motion.h reads them. */
#include <stdlib.h>
#include <string.h>

#include "pack/pack.h"

/* Appends keys of three numbers as four words each; returns their place. */
static uint32_t add_stream(ec_pack *pack, const float *keys, size_t count)
{
    uint32_t at = (uint32_t)pack->motion_words;
    for (size_t i = 0; i < count; i++, pack->motion_words += 4)
        memcpy(pack->motion + pack->motion_words, keys + 3 * i, 3 * sizeof *keys);
    return at;
}

static void add_lights(ec_pack *pack, const ec_motion *m, size_t keys)
{
    pack->motion[EC_MOTION_LIGHTS] = (uint32_t)pack->motion_words;
    for (uint32_t i = 0; i < m->light_count; i++) {
        for (size_t k = 0; k < keys; k++) add_stream(pack, m->lights[i * keys + k].position, 1);
        for (size_t k = 0; k < keys; k++) add_stream(pack, m->lights[i * keys + k].direction, 1);
    }
}

ec_result ec_pack_motion(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    const ec_motion *m = &scene->motion;
    if (!m->segments) return EC_OK;
    const uint64_t keys = m->segments + 1, streams = 1u + !!m->normals + !!m->tangents;
    const uint64_t words =
        EC_MOTION_HEADER + 4 * (m->triangle_count + keys * (streams * m->vertex_count + 2 * (uint64_t)m->light_count));
    if (words > UINT32_MAX / 2)
        return ec_fail(err, "%u moving vertices at %llu moments are more than can be numbered; give a shorter --shutter", m->vertex_count,
                       (unsigned long long)keys);
    pack->motion = calloc(words, sizeof *pack->motion);
    if (!pack->motion) return ec_fail(err, "out of memory for %u moving vertices", m->vertex_count);
    pack->motion[EC_MOTION_SEGMENTS] = m->segments;
    pack->motion[EC_MOTION_TRIANGLES] = m->triangle_count;
    pack->motion[EC_MOTION_VERTICES] = m->vertex_count;
    pack->motion_words = EC_MOTION_HEADER;
    for (size_t t = 0; t < m->triangle_count; t++, pack->motion_words += 4)
        memcpy(pack->motion + pack->motion_words, scene->indices + 3 * t, 3 * sizeof *scene->indices);
    const size_t count = (size_t)m->vertex_count * keys;
    pack->motion[EC_MOTION_POSITIONS] = add_stream(pack, m->positions, count);
    if (m->normals) pack->motion[EC_MOTION_NORMALS] = add_stream(pack, m->normals, count);
    if (m->tangents) pack->motion[EC_MOTION_TANGENTS] = add_stream(pack, m->tangents, count);
    add_lights(pack, m, keys);
    return EC_OK;
}
