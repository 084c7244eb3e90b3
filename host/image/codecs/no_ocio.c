/* Stands in for OpenColorIO, which is used only if cmake is given -DECLAT_OCIO=ON. */
#include <stddef.h>

#include "image/ocio.h"

const bool ec_has_ocio = false;

ec_result ec_ocio_open(const ec_ocio_choice *choice, ec_ocio **ocio, ec_error *err)
{
    *ocio = NULL;
    return ec_fail(err, "--ocio '%.200s': this eclat was built without OpenColorIO; build it with cmake -DECLAT_OCIO=ON, or leave --ocio out", choice->config);
}

void ec_ocio_show(const ec_ocio *ocio, float *rgb, uint64_t pixels) { (void)ocio, (void)rgb, (void)pixels; }

void ec_ocio_close(ec_ocio *ocio) { (void)ocio; }
