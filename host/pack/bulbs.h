/* Bulbs: lamp triangles that share corners and are of one emission, and of which the lamp that shines on a far point is as well chosen by its power as by
 * the light tree: closed bodies, whose triangles are pairs (lamp_pairs.h), and panels; none larger than EC_LIGHT_TREE_BODY says. */
#ifndef EC_PACK_BULBS_H
#define EC_PACK_BULBS_H

#include "pack/pack.h"

/* Which body each light is of: the place of its first lamp. Lamp triangles of one emission that share a corner are of one body; everything else is one by
 * itself, and so is each light where there are very many. root: room for pack->light_count, the caller's. */
ec_result ec_lamp_bodies(const ec_pack *pack, uint32_t *root, ec_error *err);

/* Puts the lamps of each bulb beside each other in the table, and in it those of each pair; the rest keeps its order. root: of ec_lamp_bodies. Where lamps stand still and the tree
 * is still to come. Before there are casters. */
ec_result ec_pack_bulbs(ec_pack *pack, const uint32_t *root, ec_error *err);

#endif
