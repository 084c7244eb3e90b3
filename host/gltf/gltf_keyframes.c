/* Evaluates an animation's sampler at one moment: glTF 2.0, appendix C. */
#include "gltf/gltf_keyframes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_NUMBERS 65536 /* at one key: no mesh has more morph targets */

typedef struct curve {
    const ec_gltf *g;
    const ec_gltf_accessor *times, *values;
    ec_interpolation interpolation;
    uint32_t components, per_key; /* elements per key: the number of weights, else 1 */
} curve;

static float key_time(const curve *c, uint64_t key)
{
    float time;
    ec_gltf_accessor_floats(c->times, key, 1, &time);
    return time;
}

static ec_result check_times(const curve *c, const char *where, ec_error *err)
{
    float last = -INFINITY;
    if (c->times->components != 1 || c->times->component_type != EC_GLTF_FLOAT)
        return ec_fail(err, "%s: the times of its keys must be float scalars", where);
    for (uint64_t i = 0; i < c->times->count; i++) {
        float time = key_time(c, i);
        if (!isfinite(time) || time <= last)
            return ec_fail(err, "%s: the times of its keys must increase: key %llu is at %g s, after %g s", where,
                           (unsigned long long)i, (double)time, (double)last);
        last = time;
    }
    return EC_OK;
}

static ec_result open_curve(ec_gltf *g, const ec_gltf_keyframes *k, const char *where, curve *c, ec_error *err)
{
    EC_TRY(ec_gltf_accessor_open(g, k->input, where, err));
    EC_TRY(ec_gltf_accessor_open(g, k->output, where, err));
    *c = (curve){.g = g, .times = &g->accessors[k->input], .values = &g->accessors[k->output], .interpolation = k->interpolation};
    EC_TRY(check_times(c, where, err));
    uint64_t keys = c->times->count * (k->interpolation == EC_CUBICSPLINE ? 3 : 1), per_key = c->values->count / keys;
    c->components = c->values->components;
    bool fits = per_key * keys == c->values->count && per_key >= 1 && per_key <= MAX_NUMBERS &&
                (c->components == 1 || per_key == 1);
    if (!fits)
        return ec_fail(err, "%s: accessors[%d] has %llu elements, which does not match the %llu keys of accessors[%d]", where, k->output,
                       (unsigned long long)c->values->count, (unsigned long long)c->times->count, k->input);
    c->per_key = (uint32_t)per_key;
    return EC_OK;
}

enum { IN_TANGENT, VALUE, OUT_TANGENT };

/* Reads all numbers of a key. Parts other than VALUE exist only in cubic splines. */
static void read_key(const curve *c, uint64_t key, int part, double *out)
{
    uint64_t first = c->interpolation == EC_CUBICSPLINE ? 3 * key + (uint64_t)part : key;
    for (uint32_t i = 0; i < c->per_key; i++) {
        float element[16];
        ec_gltf_accessor_floats(c->values, first * c->per_key + i, c->components, element);
        for (uint32_t k = 0; k < c->components; k++) out[i * c->components + k] = element[k];
    }
}

/* Returns the last key that is not after `at`; -1: all are after it. */
static int64_t find_key(const curve *c, double at)
{
    uint64_t low = 0, high = c->times->count;
    while (low < high) {
        uint64_t middle = low + (high - low) / 2;
        if ((double)key_time(c, middle) <= at) low = middle + 1;
        else high = middle;
    }
    return (int64_t)low - 1;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static void normalize(double q[4])
{
    double length = sqrt(dot(q, q));
    for (int i = 0; i < 4 && length > 0; i++) q[i] /= length;
}

/* Interpolates along the shorter arc or, if the two nearly agree, along the chord; the result is in a. Normalises both. */
static void slerp(double a[4], double b[4], double t)
{
    normalize(a);
    normalize(b);
    double cosine = dot(a, b), sign = cosine < 0 ? -1 : 1;
    cosine *= sign;
    double u = 1 - t, v = t;
    if (cosine < 1 - 1e-9) {
        double angle = acos(cosine);
        u = sin(angle * (1 - t)) / sin(angle);
        v = sin(angle * t) / sin(angle);
    }
    for (int i = 0; i < 4; i++) a[i] = u * a[i] + v * sign * b[i];
}

/* Interpolates between a key and the next, at fraction t; `out` holds the key's value, and then the result. `work` has room for three values. */
static void interpolate(const curve *c, uint64_t key, double t, double duration, bool rotation, double *out, double *work)
{
    uint32_t n = c->components * c->per_key;
    double *next = work, *leave = work + n, *arrive = work + 2 * n;
    if (c->interpolation == EC_STEP) return;
    read_key(c, key + 1, VALUE, next);
    if (c->interpolation == EC_LINEAR && !memcmp(out, next, n * sizeof *out)) return; /* unchanged, to the last bit */
    if (c->interpolation == EC_LINEAR && rotation) {
        slerp(out, next, t);
        return;
    }
    if (c->interpolation == EC_LINEAR) {
        for (uint32_t i = 0; i < n; i++) out[i] = (1 - t) * out[i] + t * next[i];
        return;
    }
    read_key(c, key, OUT_TANGENT, leave);
    read_key(c, key + 1, IN_TANGENT, arrive);
    double t2 = t * t, t3 = t2 * t;
    for (uint32_t i = 0; i < n; i++)
        out[i] = (2 * t3 - 3 * t2 + 1) * out[i] + duration * (t3 - 2 * t2 + t) * leave[i] + (3 * t2 - 2 * t3) * next[i] +
                 duration * (t3 - t2) * arrive[i];
}

static ec_result evaluate(const curve *c, bool rotation, double at, const char *where, double *out, double *work, ec_error *err)
{
    int64_t key = find_key(c, at);
    read_key(c, key < 0 ? 0 : (uint64_t)key, VALUE, out);
    if (key >= 0 && (uint64_t)key + 1 < c->times->count) {
        double start = (double)key_time(c, (uint64_t)key), duration = (double)key_time(c, (uint64_t)key + 1) - start;
        interpolate(c, (uint64_t)key, (at - start) / duration, duration, rotation, out, work);
    }
    for (uint32_t i = 0; i < c->components * c->per_key; i++)
        if (!isfinite((float)out[i])) return ec_fail(err, "%s: NaN or infinity at %g s", where, at);
    return EC_OK;
}

ec_result ec_gltf_keyframes_sample(ec_gltf *g, const ec_gltf_keyframes *keyframes, bool rotation, double at, const char *where,
                                   ec_gltf_numbers *numbers, ec_error *err)
{
    curve c;
    EC_TRY(open_curve(g, keyframes, where, &c, err));
    if (rotation && c.components != 4) return ec_fail(err, "%s: a rotation takes 4 numbers, not %u", where, c.components);
    numbers->count = c.components * c.per_key;
    numbers->values = malloc(4 * (size_t)numbers->count * sizeof *numbers->values);
    if (!numbers->values) return ec_fail(err, "%s: out of memory", where);
    return evaluate(&c, rotation, at, where, numbers->values, numbers->values + numbers->count, err);
}

uint32_t ec_gltf_keyframes_between(const ec_gltf *g, const ec_gltf_keyframes *keyframes, double from, double to)
{
    const curve c = {.g = g, .times = &g->accessors[keyframes->input]};
    int64_t count = find_key(&c, nextafter(to, -INFINITY)) - find_key(&c, from);
    return count > 0 ? (uint32_t)count : 0;
}
