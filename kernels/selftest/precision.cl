/* The library's functions over arrays of inputs, for comparison with the same text in double precision
 * (host/selftest/precision.h, which also has where the inputs come from and what the results are called). */
#include "../shared/features.h"

/* As glTF has it; precision_multiscatter calls what gives back more. */
#undef FEATURES
#define FEATURES (EC_FEATURE_ALL & ~EC_FEATURE_MULTISCATTER)
#include "precision_bsdf.h"
#include "precision_light.h"
#include "precision_math.h"
#include "precision_surface.h"
