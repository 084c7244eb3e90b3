/* Built without libavif: as it is, unless cmake is told -DECLAT_AVIF=ON. */
#include "image/gather.h"

ec_encode *const ec_encode_avif = NULL;
