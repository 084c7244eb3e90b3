/* Programs that stay built as long as the device is open, for many renders of small scenes. */
#include "cl/kept.h"

#include <stdlib.h>
#include <string.h>

struct ec_kept_program {
    ec_cache_key key;
    cl_program program;
};

cl_program ec_kept_find(const ec_cl *cl, const ec_cache_key *key)
{
    for (uint32_t i = 0; i < cl->kept_count; i++)
        if (!memcmp(&cl->kept[i].key, key, sizeof *key)) return cl->kept[i].program;
    return NULL;
}

void ec_kept_add(ec_cl *cl, const ec_cache_key *key, cl_program program)
{
    ec_kept_program *grown = realloc(cl->kept, (cl->kept_count + 1) * sizeof *grown);
    if (!grown) return;
    cl->kept = grown;
    if (clRetainProgram(program) == CL_SUCCESS) cl->kept[cl->kept_count++] = (ec_kept_program){*key, program};
}

void ec_kept_release(ec_cl *cl)
{
    for (uint32_t i = 0; i < cl->kept_count; i++) clReleaseProgram(cl->kept[i].program);
    free(cl->kept);
    cl->kept = NULL;
    cl->kept_count = 0;
}
