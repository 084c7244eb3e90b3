/* Bulbs: lamp triangles that share corners and are of one emission, and of which the lamp that shines on a far point is as well chosen by its power as by
 * the light tree: closed bodies, whose triangles are pairs (lamp_pairs.h), and panels. */
#ifndef EC_PACK_BULBS_H
#define EC_PACK_BULBS_H

#include "pack/pack.h"

/* Puts the lamps of each bulb beside each other in the table, and in it those of each pair; the rest keeps its order. Where lamps stand still and the tree
 * is still to come. Before there are casters. */
ec_result ec_pack_bulbs(ec_pack *pack, ec_error *err);

#endif
