/* Programs that stay built, and buffers that stay on the device, as long as it is open. Inside host/cl only. */
#ifndef EC_CL_KEPT_H
#define EC_CL_KEPT_H

#include "cl/cache.h"

typedef struct ec_kept_program ec_kept_program;

cl_program ec_kept_find(const ec_cl *cl, const ec_cache_key *key); /* borrowed; NULL: none */
void ec_kept_add(ec_cl *cl, const ec_cache_key *key, cl_program program); /* retains it; if there is no memory it is just not kept */
void ec_kept_release(ec_cl *cl);

typedef struct ec_kept_buffer {
    ec_fingerprint key;
    cl_mem buffer;
} ec_kept_buffer;

void ec_kept_buffers_release(ec_cl *cl);

#endif
