/* Light from infinitely far away: one colour, or an equirectangular picture. Its orientation is that of Khronos' sample viewer and three.js; see
 * scene.h. */
#include "base/text.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/hdr.h"
#include "image/image.h"
#include "scene/built_in.h"

/* Parses "R,G,B". Returns 1 for three valid numbers, 0 if it does not look like numbers (so it is a file name), -1 for invalid numbers. */
static int parse_color(const char *spec, float rgb[3])
{
    /* includes the letters of inf, infinity, nan and hexadecimal numbers, which are refused as numbers */
    if (strspn(spec, "0123456789+-.eE, \tinfatyINFATYxX") != strlen(spec) || !strchr(spec, ',')) return 0;
    int used = 0;
    bool is_good = !strpbrk(spec, "xX") && sscanf(spec, "%f ,%f ,%f %n", &rgb[0], &rgb[1], &rgb[2], &used) == 3 && used && !spec[used];
    for (int i = 0; i < 3; i++) is_good = is_good && isfinite(rgb[i]) && rgb[i] >= 0;
    return is_good ? 1 : -1;
}

static void clean(float *values, uint64_t count, const char *spec, const ec_log *log)
{
    uint64_t bad = 0, bright = 0;
    for (uint64_t i = 0; i < count; i++) {
        if (!isfinite(values[i]) || values[i] < 0) {
            values[i] = 0;
            bad++;
        } else if (values[i] > EC_RADIANCE_MOST) {
            values[i] = EC_RADIANCE_MOST;
            bright++;
        }
    }
    if (bad) ec_warn(log, "%s: %llu values are NaN, infinite or negative; they are taken as 0", spec, (unsigned long long)bad);
    if (bright)
        ec_warn(log, "%s: %llu values are above %g; they are clamped to it", spec, (unsigned long long)bright, (double)EC_RADIANCE_MOST);
}

ec_result ec_scene_set_environment(ec_scene *s, const char *spec, const ec_log *log, ec_error *err)
{
    ec_environment e = {0};
    int color = parse_color(spec, e.constant);
    if (color < 0)
        return ec_fail(err, "environment \"%.*s\": give three numbers separated by commas, none negative, e.g. 1,1,1",
                       EC_CUT(spec, 200));
    if (color) {
        clean(e.constant, 3, spec, log);
    } else if (ec_is_built_in(spec)) {
        ec_made_map map;
        EC_TRY(ec_built_in_make(spec, &map, err));
        e = (ec_environment){.width = map.width, .height = map.height, .rgb = map.rgb};
    } else {
        memset(e.constant, 0, sizeof e.constant);
        EC_TRY(ec_image_read_rgb(spec, &e.width, &e.height, &e.rgb, err));
        if (ec_hdr_has_exposure(spec))
            ec_warn(log, "%s: its EXPOSURE is not applied: pixels are used as stored, as most programs do; --env-strength scales them", spec);
        clean(e.rgb, 3 * (uint64_t)e.width * e.height, spec, log);
    }
    if (!s->environment.lent) free(s->environment.rgb);
    s->environment = e;
    s->has_environment = true;
    return EC_OK;
}

/* Multiplies turn by a rotation about +y from the left. */
void ec_environment_turn(ec_environment *e, double degrees)
{
    static const float upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (fmod(degrees, 360) == 0) return;
    double angle = fmod(degrees, 360) * 3.14159265358979323846 / 180, c = cos(angle), s = sin(angle);
    float before[9];
    memcpy(before, e->turned ? e->turn : upright, sizeof before);
    for (int k = 0; k < 3; k++) {
        e->turn[k] = (float)(c * before[k] + s * before[6 + k]);
        e->turn[3 + k] = before[3 + k];
        e->turn[6 + k] = (float)(c * before[6 + k] - s * before[k]);
    }
    e->turned = true;
}

void ec_scene_adjust_environment(ec_scene *s, double degrees, double strength, const ec_log *log)
{
    ec_environment *e = &s->environment;
    if (strength == 0) {
        free(e->rgb);
        *e = (ec_environment){0};
        s->has_environment = false;
        return;
    }
    uint64_t count = e->rgb ? 3 * (uint64_t)e->width * e->height : 3;
    float *values = e->rgb ? e->rgb : e->constant;
    for (uint64_t i = 0; strength != 1 && i < count; i++) values[i] = (float)fmin(values[i] * strength, FLT_MAX);
    if (strength != 1) clean(values, count, "the environment, scaled", log);
    if (e->rgb) ec_environment_turn(e, degrees);
}
