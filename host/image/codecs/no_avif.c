/* Stands in for libavif, which is used only if cmake is given -DECLAT_AVIF=ON. */
#include "image/gather.h"

ec_encode *const ec_encode_avif = NULL;
