/* Layers over the base of a surface, under its coat. A layer X has a header of its own with
 *
 *   X_look                  its parameters at a point
 *   X_read(g, h, m)         reads them from the material
 *   X_hide(m, look)         removes the layer on the lanes m
 *   X                       made from a look once a hit; own: about what it reflects, p: probability of sampling it
 *   X_make(look, wo, under) under: about what is reflected under it
 *   X_over(x, wo, wi, f, pdf)        lays its value and density over those of what is under it
 *   X_leaves(x, cosine)              returns the share of light along a single direction that gets through it
 *   X_sample(x, wo, cosine, sine, u) samples a direction; cosine, sine: of an angle that is uniform, as u is
 *   X_ambient(x, under)              returns the albedo under light that is the same from everywhere
 *
 * and a row here. It has no single directions. */
#ifndef EC_LIB_LAYERS_H
#define EC_LIB_LAYERS_H

#include "sheen.h"

/* X(FEATURE, layer) from the lowest layer up, and from the uppermost down. */
#define LAYERS_UP(X) X(SHEEN, sheen)
#define LAYERS_DOWN(X) X(SHEEN, sheen)

#endif
