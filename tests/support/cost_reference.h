/* The reference of a cost study: a long render of the same scene, with a seed of its own. */
#ifndef SUPPORT_COST_REFERENCE_H
#define SUPPORT_COST_REFERENCE_H

#include "cost/cost_internal.h"
#include "support/render_case.h"

static inline ec_cost_reference cost_reference(const ec_scene *scene, const ec_render_options *options, uint32_t spp)
{
    ec_error err = {0};
    ec_cost_reference reference = {0};
    ec_render_options o = *options;
    o.spp = spp;
    o.seed = 12345;
    case_image image = case_render(scene, &o);
    CHECK_OK(ec_cost_reference_of(&image.film, &reference, &err), err);
    case_free(&image);
    return reference;
}

#endif
