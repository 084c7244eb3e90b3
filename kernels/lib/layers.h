/* What lies over the base of a surface, under its coat. A layer X is a header of its own with
 *
 *   X_look                  what a material says of it at a point
 *   X_read(g, h, m)         reads that
 *   X_hide(m, look)         where there is none of it after all
 *   X                       made of a look once a hit, with own, about what it reflects, and p, the probability of sampling it
 *   X_make(look, wo, under) under: about what is reflected under it
 *   X_over(x, wo, wi, f, pdf)        lays its value and density over those of what is under it
 *   X_leaves(x, cosine)              of light along a single direction, what it leaves to that
 *   X_sample(x, wo, cosine, sine, u) a direction; cosine, sine: of an angle that is uniform, as u is
 *   X_ambient(x, under)              what of light from everywhere comes back
 *
 * and a row here. It has no single directions. */
#ifndef EC_LIB_LAYERS_H
#define EC_LIB_LAYERS_H

#include "sheen.h"

/* X(FEATURE, layer), the lowest first; and the uppermost first. */
#define LAYERS_UP(X) X(SHEEN, sheen)
#define LAYERS_DOWN(X) X(SHEEN, sheen)

#endif
