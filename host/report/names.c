#include "report/names.h"

#include <stddef.h>
#include <stdio.h>

#include "image/image.h"
#include "render/render.h"

const char *const ec_compile_names[] = {[EC_COMPILE_AUTO] = "auto", [EC_COMPILE_BESIDE] = "beside", [EC_COMPILE_FIRST] = "first", [EC_COMPILE_NARROW] = "narrow", NULL};
const char *const ec_begun_names[] = {[EC_BEGUN_FAST] = "fast", [EC_BEGUN_NARROW] = "narrow", [EC_BEGUN_UNIVERSAL] = "universal", NULL};
const char *const ec_instancing_names[] = {
    [EC_INSTANCING_AUTO] = "auto", [EC_INSTANCING_OFF] = "off", [EC_INSTANCING_ON] = "on", NULL};
const char *const ec_filter_names[] = {[EC_FILTER_BOX] = "box", [EC_FILTER_BLACKMAN_HARRIS] = "blackman-harris", NULL};
const char *const ec_light_choice_names[] =
    {[EC_LIGHTS_AUTO] = "auto", [EC_LIGHTS_BY_POWER] = "power", [EC_LIGHTS_BY_TREE] = "tree", NULL};
const char *const ec_integrator_names[] = {[EC_INTEGRATOR_PATH] = "path",
                                           [EC_INTEGRATOR_WHITTED] = "whitted",
                                           [EC_INTEGRATOR_RASTER] = "raster",
                                           [EC_INTEGRATOR_LIGHT] = "light", NULL};
const char *const ec_sample_names[] = {
    [EC_SAMPLE_MIS] = "mis", [EC_SAMPLE_LIGHT] = "light", [EC_SAMPLE_BSDF] = "bsdf", [EC_SAMPLE_HEMISPHERE] = "hemisphere", NULL};
const char *const ec_sampler_names[] = {
    [EC_SAMPLER_SOBOL] = "sobol", [EC_SAMPLER_INDEPENDENT] = "independent", NULL};
const char *const ec_scattering_names[] = {
    [EC_SCATTERING_SINGLE] = "single", [EC_SCATTERING_MULTIPLE] = "multiple", NULL};

const char *const ec_terminator_names[] = {
    [EC_TERMINATOR_GEOMETRIC] = "geometric", [EC_TERMINATOR_SMOOTH] = "smooth", NULL};
ec_background_text ec_background_name(const ec_background *b)
{
    ec_background_text t = {"env"};
    if (b->kind == EC_BACKDROP_TRANSPARENT) return (ec_background_text){"transparent"};
    if (b->kind == EC_BACKDROP_COLOR) snprintf(t.text, sizeof t.text, "#%02x%02x%02x", b->rgb[0], b->rgb[1], b->rgb[2]);
    if (b->kind == EC_BACKDROP_BLUR) snprintf(t.text, sizeof t.text, "blur:%g", (double)b->degrees);
    return t;
}

#define NAME(id, name, words) [EC_TONEMAP_##id] = name,
const char *const ec_tonemap_names[] = {EC_TONE_CURVES(NAME) NULL};
