/* Triangles as the rasteriser reads them. */
#ifndef EC_SHARED_RASTER_H
#define EC_SHARED_RASTER_H

#include "types.h"

/* A triangle in the homogeneous coordinates of the picture (Olano & Greer 1997): functions f(x, y) = f[0] x + f[1] y + f[2]
 * of the place in the picture, x and y in [-1, 1], y up. */
typedef struct ec_raster_tri {
    ec_float edge[3][3];  /* proportional to the barycentrics; >= 0 inside, whichever way the triangle faces */
    ec_float nearness[3]; /* perspective: 1 / distance in units of the view direction; orthographic: -distance */
    ec_uint first_tile, last_tile; /* x | y << 16 of the corners of the box of tiles that it may meet */
    ec_uint prim;         /* EC_NO_ID: it is out of sight or seen edge-on */
    ec_uint pad;
} ec_raster_tri;
EC_ASSERT_SIZE(ec_raster_tri, 64);

#endif
