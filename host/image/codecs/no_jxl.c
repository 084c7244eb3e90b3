/* Built without libjxl: as it is, unless cmake is told -DECLAT_JXL=ON. */
#include "image/gather.h"

ec_encode *const ec_encode_jxl = NULL;
