/* Edges of triangles, which rays may pass. Inside host/rare only. */
#ifndef EC_RARE_EDGES_H
#define EC_RARE_EDGES_H

#include "rare/lights.h"

/* Takes points beside all edges, those of meshes that are kept once at all of their places; where there are many, beside some, half of them by the
 * triangles' lengths and half evenly; in random order. */
ec_result ec_rare_edges_find(const ec_pack *pack, ec_rare_lights *all, ec_error *err);

#endif
