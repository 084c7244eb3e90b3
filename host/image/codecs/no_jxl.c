/* Stands in for libjxl, which is used only if cmake is given -DECLAT_JXL=ON. */
#include "image/gather.h"

ec_encode *const ec_encode_jxl = NULL;
