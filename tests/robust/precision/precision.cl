/* The library's functions over arrays of inputs, for comparison with the same text in double precision
 * (precision.h, which also has where the inputs come from and what the results are called). */
#include "shared/features.h"

/* As glTF has it; precision_multiscatter calls what gives back more. */
#undef FEATURES
#define FEATURES (EC_FEATURE_ALL & ~EC_FEATURE_MULTISCATTER)
#include "kernel_bsdf.h"
#include "kernel_light.h"
#include "kernel_math.h"
#include "kernel_surface.h"
