/* The few samples that moved their pixels' means the most: do they decide the picture's error? */
#ifndef EC_FILM_TAIL_H
#define EC_FILM_TAIL_H

#include <stdint.h>

enum { EC_TAIL_FEW = 12 };

/* The largest values seen, the largest first. Whatever the order in which they come, the same are kept. */
typedef struct ec_tail {
    uint32_t count;
    double largest[EC_TAIL_FEW];
} ec_tail;

void ec_tail_add(ec_tail *tail, double value);
void ec_tail_join(ec_tail *into, const ec_tail *next);

#endif
