/* Layers of a picture beside its radiance: parts of that, or where its first surface is. */
#ifndef EC_FILM_LAYERS_H
#define EC_FILM_LAYERS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/matte_kinds.h"
#include "shared/params.h"

enum { EC_LAYER_BYTES = 12 /* of a pixel in a batch */, EC_LAYER_WAVE_MOST = 1 << 26 /* so that 32 bits number all floats of a wave */ };

/* The layers that a picture has: one of each kind, in the order of ec_layer_kind, then light groups, by name. */
typedef struct ec_layers {
    uint32_t count;
    uint32_t kinds;       /* a bit for each ec_layer_kind */
    uint32_t group_count;
    char groups[EC_GROUPS_MOST][EC_GROUP_NAME];
    uint32_t mattes;      /* a bit for each ec_matte_kind: not counted, and no films of their own (matte.h) */
    const uint32_t *matte_hashes[EC_MATTE_KINDS]; /* hashes for those, by number plus 1 of a node or a material; not owned */
} ec_layers;

static inline bool ec_layers_are_same(const ec_layers *a, const ec_layers *b)
{
    bool same = a->kinds == b->kinds && a->group_count == b->group_count;
    for (uint32_t g = 0; same && g < a->group_count; g++) same = !strcmp(a->groups[g], b->groups[g]);
    return same;
}

/* Returns the number of a kind's layer, from 1 on; 0: there is none. */
static inline uint32_t ec_layers_find(const ec_layers *layers, enum ec_layer_kind kind)
{
    return layers->kinds >> kind & 1 ? (uint32_t)__builtin_popcount(layers->kinds & ((2u << kind) - 1)) : 0;
}

/* Returns the number of the first light group's layer, likewise. */
static inline uint32_t ec_layers_groups(const ec_layers *layers) { return layers->group_count ? layers->count - layers->group_count + 1 : 0; }

#endif
