/* The largest samples of a picture: do a few of them decide its error? Of each pixel the film knows its largest sample; by how much that one
 * moved the pixel's mean is what is looked at here. */
#ifndef EC_FILM_TAIL_H
#define EC_FILM_TAIL_H

#include <stdint.h>

enum { EC_TAIL_KEPT = 64, EC_TAIL_FEW = 12 };

/* The largest values seen, the largest first. Whatever the order in which they come, the same are kept. */
typedef struct ec_tail {
    uint32_t count;
    double largest[EC_TAIL_KEPT];
} ec_tail;

void ec_tail_add(ec_tail *tail, double value);
void ec_tail_join(ec_tail *into, const ec_tail *next);

/* k of the generalised Pareto distribution that fits the excess of the largest values over the last one kept: over 0.5 their squares have no
 * mean, over 1 they have none themselves. (Zhang and Stephens 2009, with the prior of Vehtari et al. 2024, eq. 9.) 0 where there are
 * fewer than EC_TAIL_KEPT. Its standard error is about (1 + k) / sqrt(EC_TAIL_KEPT). */
double ec_tail_shape(const ec_tail *tail);

#endif
