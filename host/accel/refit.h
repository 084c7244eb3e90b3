/* Refits structures as what they hold moves: the tree stays, its boxes follow. */
#ifndef EC_ACCEL_REFIT_H
#define EC_ACCEL_REFIT_H

#include "accel/accel.h"

/* Returns whether this kind can be refitted, as the BVHs can. */
bool ec_accel_can_refit(uint32_t which);

/* Updates `accel`, built of the same triangles at other places, to those of `input`: makes triangles and boxes anew, from the leaves up, in time
 * that grows with their number alone. No triangle may have been cut. Every hit is the same as with a structure that is built anew, to the last
 * bit: a box holds what is below it, a triangle's own box is its own, and ties go by its number. Only time is at stake, which grows with what
 * ec_accel_expense says. */
void ec_accel_refit(uint32_t which, const ec_accel_input *input, ec_accel *accel);

/* Returns the expected cost of a ray (MacDonald and Booth 1990), in units that compare trees of one kind only; 0: not known. */
double ec_accel_expense(uint32_t which, const ec_accel *accel);

#endif
