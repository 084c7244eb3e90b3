#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/numbers.h"
#include "live/shared.h"

/* Rounds to nine digits. */
static double rounded(double number)
{
    char text[40];
    snprintf(text, sizeof text, "%.9g", number);
    return strtod(text, NULL);
}

void ec_live_limit_view(eclat_view_request *w)
{
    eclat_viewpoint *v = &w->viewpoint;
    for (int k = 0; k < 3 && w->is_moved; k++) v->eye[k] = rounded(v->eye[k]), v->target[k] = rounded(v->target[k]), v->up[k] = rounded(v->up[k]);
    if (w->is_moved) v->fov = rounded(v->fov), v->tall = rounded(v->tall);
    w->width = w->width < EC_SIZE_MAX_SIDE ? w->width : EC_SIZE_MAX_SIDE;
    w->height = w->height < EC_SIZE_MAX_SIDE ? w->height : EC_SIZE_MAX_SIDE;
    if (!w->width || !w->height) w->width = w->height = 0;
    w->env_degrees = isfinite(w->env_degrees) ? rounded(w->env_degrees) : 0;
    w->exposure = rounded(fmin(fmax(w->exposure, -EC_EXPOSURE_MOST), EC_EXPOSURE_MOST));
    w->is_denoised = w->is_denoised != 0;
    if (w->tonemap >= ECLAT_TONEMAP_COUNT) w->tonemap = ECLAT_TONEMAP_NEUTRAL;
    if (w->integrator >= ECLAT_INTEGRATOR_COUNT) w->integrator = ECLAT_PATH;
    if (w->second_integrator >= ECLAT_INTEGRATOR_COUNT) w->second_integrator = ECLAT_PATH;
    if (w->second >= ECLAT_SECOND_COUNT) w->second = ECLAT_SECOND_NONE;
}

bool ec_live_same_camera(const eclat_view_request *a, const eclat_view_request *b)
{
    return a->is_moved == b->is_moved && a->camera == b->camera && a->width == b->width && a->height == b->height &&
           a->env_degrees == b->env_degrees && a->is_denoised == b->is_denoised && (!a->is_moved || !memcmp(&a->viewpoint, &b->viewpoint, sizeof a->viewpoint));
}
