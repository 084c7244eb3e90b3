/* Rays that leave lights. Inside host/rare only. */
#ifndef EC_RARE_LEAVE_H
#define EC_RARE_LEAVE_H

#include "rare/chains.h"

/* Sets two unit vectors at right angles to a third and to each other. */
void ec_rare_frame(const float normal[3], double u[3], double v[3]);

/* Starts a ray anywhere on a lamp, in a direction distributed as its light is. */
void ec_rare_leave_lamp(const ec_rare_lamp *lamp, uint64_t *random, ec_chain *ray);

/* Starts one of `count` rays from a point or spot light, spread evenly over the directions that it shines in. Returns the solid angle that it stands for. */
double ec_rare_leave_point(const ec_rare_source *source, uint32_t number, uint32_t count, ec_chain *ray);

#endif
