#include "device/kernel_set.h"

#include <string.h>

static void release(cl_kernel kernel)
{
    if (kernel) clReleaseKernel(kernel);
}

void ec_kernel_set_release(ec_kernel_set *set)
{
    for (int i = 0; i < EC_STAGE_ID_COUNT; i++) release(set->stages[i].kernel);
    for (int a = 0; a < EC_ACCEL_COUNT; a++)
        for (int i = 0; i < 2; i++) release(set->traverse[a][i].kernel);
    for (int i = 0; i <= EC_LANES_MOST; i++)
        if (set->programs[i]) clReleaseProgram(set->programs[i]);
    memset(set, 0, sizeof *set);
}
