/* Programs that stay built as long as the device is open. Inside host/cl only. */
#ifndef EC_CL_KEPT_H
#define EC_CL_KEPT_H

#include "cl/cache.h"

typedef struct ec_kept_program ec_kept_program;

cl_program ec_kept_find(const ec_cl *cl, const ec_cache_key *key); /* borrowed; NULL: none */
void ec_kept_add(ec_cl *cl, const ec_cache_key *key, cl_program program); /* retains it; without memory it is just not kept */
void ec_kept_release(ec_cl *cl);

#endif
