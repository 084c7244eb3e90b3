/* Packs the places of instances, for shading. */
#include <stdlib.h>
#include <string.h>

#include "pack/pack.h"

static ec_place place_of(const ec_scene *scene, const ec_placed *p)
{
    ec_place place = {.id = p->id, .first = scene->shapes[p->shape].first, .turned = p->mirrored};
    memcpy(place.place, p->place, sizeof place.place);
    for (int row = 0; row < 3; row++) memcpy(place.normal[row], p->normal[row], sizeof p->normal[row]);
    return place;
}

ec_result ec_pack_places(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    const uint32_t count = scene->placed_count;
    if (!count) return EC_OK;
    ec_place_header header = {.count = count, .first_id = scene->placed[0].id, .ids = 4 + count * EC_PLACE_WORDS};
    for (uint32_t step = 1; step < count; step *= 2) header.step = step;
    uint64_t words = header.ids + (uint64_t)count;
    if (words > UINT32_MAX) return ec_fail(err, "%u instances are more than a buffer can hold", count);
    pack->place_words = (uint32_t)words;
    pack->places = malloc(words * sizeof *pack->places);
    if (!pack->places) return ec_fail(err, "out of memory for %u instances", count);
    memcpy(pack->places, &header, sizeof header);
    for (uint32_t i = 0; i < count; i++) {
        const ec_place place = place_of(scene, &scene->placed[i]);
        memcpy(pack->places + 4 + (size_t)i * EC_PLACE_WORDS, &place, sizeof place);
        pack->places[header.ids + i] = place.id;
    }
    return EC_OK;
}
