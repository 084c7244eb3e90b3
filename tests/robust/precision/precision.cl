/* The library's functions over arrays of inputs, for comparison with the same source in double precision (precision.h, which also describes
 * the inputs and names the results). */
#include "shared/features.h"

/* glTF's single scattering; precision_multiscatter calls the function that adds multiple scattering. */
#undef FEATURES
#define FEATURES (EC_FEATURE_ALL & ~EC_FEATURE_MULTISCATTER)
#include "kernel_bsdf.h"
#include "kernel_light.h"
#include "kernel_math.h"
#include "kernel_surface.h"
