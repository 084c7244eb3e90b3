/* Layout of kernels/shared by the device's compiler. One number for each line of layouts.h. */
#include "layouts.h"
#include "shared/accel.h"
#include "shared/params.h"
#include "shared/scene_buffers.h"

/* __builtin_offsetof exists in Clang and GCC only; this works in every compiler. */
#define OFFSET(type, field) (uint)((size_t)&((global type *)0)->field)
#define SIZE_(type) out[i++] = (uint)sizeof(type);
#define FIELD_(type, field) out[i++] = OFFSET(type, field);
#define NUMBER_(x) out[i++] = (uint)(x);

kernel void layouts(global uint *out)
{
    uint i = 0;
    LAYOUTS(SIZE_, FIELD_, NUMBER_)
}
