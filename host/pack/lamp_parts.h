/* Lamps whose texture varies, cut into triangles of which each is about as bright as all of itself: kernels/lib/lamp_parts.h chooses among them.
 * Inside host/pack only. */
#ifndef EC_PACK_LAMP_PARTS_H
#define EC_PACK_LAMP_PARTS_H

#include "pack/pack.h"

/* Uneven light costs noise: a triangle sampled evenly has the noise of one as bright as its root mean square. */
#define EC_LAMP_UNEVEN 1.25   /* over its mean, from which on a lamp is cut … */
#define EC_LAMP_EVEN 1.02     /* … and up to which a part of it is not */
#define EC_LAMP_EXCESS 0.01   /* of all textured lamps' light: what is left of those differences when enough is cut */
#define EC_LAMP_CUTS 8000    /* in all */
#define EC_LAMP_DEPTH 12      /* halvings of an edge */
#define EC_LAMP_TEXELS 0.25   /* across which a part is not cut further */

/* Cuts those of `count` lights that are triangles with a texture: a lamp that is cut has its first node in its kind and in pack->prims' flags, and its
 * power set right. may_cut: by triangle. */
ec_result ec_lamp_parts_find(const ec_scene *scene, ec_pack *pack, ec_light_data *lights, double *power, uint32_t count, const bool *may_cut,
                             ec_error *err);

#endif
