/* Bulbs: groups of lamp triangles that share corners and emission, among which the light tree would choose no better than power alone does, once the
 * lamp of a pair that faces the point is taken. They are closed bodies, whose triangles form pairs (lamp_pairs.h), and panels; none is larger than
 * EC_LIGHT_TREE_BODY allows. */
#ifndef EC_PACK_BULBS_H
#define EC_PACK_BULBS_H

#include "pack/pack.h"

/* Finds the body of each light, as the index of its first lamp. Lamp triangles of one emission that share a corner belong to one body; every other
 * light is a body by itself, and so is each light if there are very many. root: the caller's, pack->light_count entries. */
ec_result ec_lamp_bodies(const ec_pack *pack, uint32_t *root, ec_error *err);

/* Places the lamps of each bulb side by side in the table, and within a bulb those of each pair; the rest keeps its order. root: of ec_lamp_bodies.
 * For scenes whose lamps stand still, before the tree and casters are made. */
ec_result ec_pack_bulbs(ec_pack *pack, const uint32_t *root, ec_error *err);

#endif
