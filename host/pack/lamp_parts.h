/* Cuts lamps whose texture varies into triangles that are each about evenly bright; kernels/lib/lamp_parts.h chooses among them. Inside host/pack
 * only. */
#ifndef EC_PACK_LAMP_PARTS_H
#define EC_PACK_LAMP_PARTS_H

#include "pack/pack.h"

/* A triangle sampled evenly has the noise of one as bright as its root mean square. */
#define EC_LAMP_UNEVEN 1.25   /* root mean square over mean from which a lamp is cut … */
#define EC_LAMP_EVEN 1.02     /* … and up to which a part is not cut further */
#define EC_LAMP_EXCESS 0.01   /* share of the light of all textured lamps: cutting stops when this much of those differences is left */
#define EC_LAMP_CUTS 8000    /* limit of cuts in all */
#define EC_LAMP_DEPTH 12      /* limit of halvings of an edge */
#define EC_LAMP_TEXELS 0.25   /* extent up to which a part is not cut further */

/* Cuts those of `count` lights that are textured triangles: a lamp that is cut gets the index of its first node in its kind and in pack->prims'
 * flags, and its exact power. may_cut: by triangle. */
ec_result ec_lamp_parts_find(const ec_scene *scene, ec_pack *pack, ec_light_data *lights, double *power, uint32_t count, const bool *may_cut,
                             ec_error *err);

#endif
