#define EC_SHARED_SETTERS
#include "jobs/render_setters.h"

#include "jobs/defaults.h"
#include "jobs/render_request.h"
#include "jobs/setters.h"
#include "report/names.h"

#define REQUEST ((ec_render_request *)target)
#define MOMENT_MOST 1e9 /* seconds */

/* The scene */
TEXT_SETTER(scene, choice.scene)
TEXT_SETTER(variant, choice.variant)

SETTER(animation)
{
    if (!*value) return ec_usage(err, "option '--%s' needs a value that is not empty", option);
    REQUEST->choice.animation = value;
    REQUEST->choice.animated = true;
    return EC_OK;
}

SETTER(at)
{
    REQUEST->choice.animated = REQUEST->choice.at_given = true;
    return ec_parse_real(option, value, 0, MOMENT_MOST, &REQUEST->choice.at, err);
}

SETTER(shutter)
{
    REQUEST->choice.shutter = true;
    return ec_parse_span(option, value, MOMENT_MOST, &REQUEST->choice.opens, &REQUEST->choice.closes, err);
}

/* The environment */
TEXT_SETTER(env, environment)

SETTER(env_rotate)
{
    REQUEST->adjusts_env = true;
    return ec_parse_real(option, value, -36000, 36000, &REQUEST->env_degrees, err);
}

SETTER(env_strength)
{
    REQUEST->adjusts_env = true;
    return ec_parse_real(option, value, 0, 1e30, &REQUEST->env_strength, err);
}

/* The camera and its lens */
TEXT_SETTER(camera, camera)

SETTER(eye)
{
    REQUEST->look.has_eye = true;
    return ec_parse_triple(option, value, REQUEST->look.to.eye, err);
}

SETTER(look_at)
{
    REQUEST->look.has_target = true;
    return ec_parse_triple(option, value, REQUEST->look.to.target, err);
}

SETTER(up)
{
    const double *up = REQUEST->look.to.up;
    REQUEST->look.has_up = true;
    EC_TRY(ec_parse_triple(option, value, REQUEST->look.to.up, err));
    if (up[0] == 0 && up[1] == 0 && up[2] == 0) return ec_usage(err, "--%s: '%s' is no direction", option, value);
    return EC_OK;
}

SETTER(fov)
{
    REQUEST->look.has_lens = true;
    REQUEST->look.to.tall = 0;
    return ec_parse_real(option, value, EC_FOV_LEAST, EC_FOV_MOST, &REQUEST->look.to.fov, err);
}

SETTER(parallel)
{
    REQUEST->look.has_lens = true;
    REQUEST->look.to.fov = 0;
    return ec_parse_real(option, value, EC_FOCUS_LEAST, EC_FOCUS_MOST, &REQUEST->look.to.tall, err);
}

RANGE_SETTER(focus, ec_parse_real, EC_FOCUS_LEAST, EC_FOCUS_MOST, options.focus)
RANGE_SETTER(fstop, ec_parse_real, EC_FSTOP_LEAST, EC_FSTOP_MOST, options.fstop)

/* The picture and its files */
CHOICE_SETTER(filter, options.filter, ec_pixel_filter, ec_filter_names)
RANGE_SETTER(filter_width, ec_parse_real, EC_FILTER_WIDTH_LEAST, EC_FILTER_WIDTH_MOST, options.filter_width)
CHOICE_SETTER(tonemap, tonemap, ec_tonemap, ec_tonemap_names)
RANGE_SETTER(exposure, ec_parse_real, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST, exposure)

SETTER(output)
{
    (void)option;
    return ec_outputs_add(&REQUEST->outputs, value, err);
}

SETTER(size)
{
    REQUEST->has_size = true;
    return ec_parse_size(option, value, &REQUEST->options.width, &REQUEST->options.height, err);
}
