/* Averages a pixel's samples of this batch, added in sample order; limits their indirect light where it is kept apart. Reads: the slots' radiance, which
 * the limit changes. Writes: the batch film, EC_BATCH_FIELDS floats a pixel in row order from film_row on, or in the list's. Last stage of a wave. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../lib/sum.h"

static float luminance_of(global const float *in, uint wave, uint s)
{
    return 0.2126f * in[s] + 0.7152f * in[wave + s] + 0.0722f * in[2 * wave + s]; /* linear Rec. 709 */
}

/* Writes the tail of the samples' luminance: the largest, and sums of powers in units of it, so that none leaves the range of a float. */
static void write_tail(global const float *in, uint wave, uint count, global float *out)
{
    float largest = 0.0f, squares = 0.0f, fourths = 0.0f;
    for (uint s = 0; s < count; s++) largest = max(largest, luminance_of(in, wave, s));
    largest = is_finite_one(largest) ? largest : MAXFLOAT;
    if (count == 1u && largest > 0.0f) squares = fourths = 1.0f;
    for (uint s = 0; count > 1u && s < count && largest > 0.0f; s++) {
        float y = min(luminance_of(in, wave, s), largest) / largest, square = y * y;
        squares += square;
        fourths += square * square;
    }
    out[EC_BATCH_LARGEST] = largest;
    out[EC_BATCH_SQUARES] = squares;
    out[EC_BATCH_FOURTHS] = fourths;
}

/* Adds the indirect light of a pixel's samples to their direct light, scaled down to a luminance of `limit` where it has more. What was cut off
 * replaces the indirect light's red. */
static void limit_indirect(global float *direct, uint wave, uint count, float limit)
{
    global float *indirect = direct + 3 * (ulong)wave;
    for (uint s = 0; s < count; s++) {
        float y = luminance_of(indirect, wave, s);
        y = is_finite_one(y) ? y : MAXFLOAT;
        float share = limit > 0.0f && y > limit ? limit / y : 1.0f;
        for (uint c = 0; c < 3; c++) direct[c * wave + s] += share * indirect[c * wave + s];
        indirect[s] = share < 1.0f ? y - limit : 0.0f;
    }
}

/* Writes sums of what was cut off in place of the tail's powers. The largest is over the limit where anything was cut off. */
static void write_cut(global const float *cut, uint count, float limit, global float *out)
{
    float largest = out[EC_BATCH_LARGEST], unit = limit > 0.0f ? limit / largest / largest : 0.0f, sum = 0.0f, squares = 0.0f;
    for (uint s = 0; s < count && largest > 0.0f; s++) {
        float part = min(cut[s] * unit, 1e16f); /* so that no square leaves the range of a float */
        sum += part;
        squares += part * part;
    }
    out[EC_BATCH_SQUARES] = sum;
    out[EC_BATCH_FOURTHS] = squares;
}

static float splat_sum(global const uint *words, float unit)
{
    return ((float)words[1] * 4294967296.0f + (float)words[0]) * unit;
}

/* Adds what light paths brought to the pixel. Of these contributions only the largest luminance is known, so their powers are bounded as if all were
 * as large. */
static void add_splats(global const uint *splat, float unit, uint batch, global float *out)
{
    float most = as_float(splat[EC_SPLAT_LARGEST]), largest = max(out[EC_BATCH_LARGEST], most);
    if (!(most > 0.0f)) return;
    float r = splat_sum(splat + EC_SPLAT_R, unit), g = splat_sum(splat + EC_SPLAT_G, unit), b = splat_sum(splat + EC_SPLAT_B, unit);
    out[EC_BATCH_R] += r / (float)batch;
    out[EC_BATCH_G] += g / (float)batch;
    out[EC_BATCH_B] += b / (float)batch;
    float y = luminance_one(r, g, b), before = out[EC_BATCH_LARGEST] / largest, before2 = before * before, at_most = most / largest, count = y / largest;
    out[EC_BATCH_SQUARES] = out[EC_BATCH_SQUARES] * before2 + at_most * count;
    out[EC_BATCH_FOURTHS] = out[EC_BATCH_FOURTHS] * before2 * before2 + at_most * at_most * at_most * count;
    out[EC_BATCH_LARGEST] = largest;
}

#define ACCUMULATE_PARAMETERS(DO)                                                                                                                     \
    DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, pixel_count) DO(global float *, radiance) DO(global float *, batch_film)       \
    DO(global const uint *, splats)

static void accumulate_one(constant ec_params *params, global float *radiance, global const uint *splats, uint place, global float *out)
{
    uint wave = params->wave, batch = params->batch;
    if (params->apart) limit_indirect(radiance, wave, batch, params->limit);
    for (uint c = 0; c < 3; c++) out[c] = mean_of(radiance + c * wave, batch);
    write_tail(radiance, wave, batch, out);
    if (params->light_paths > 0.0f && !params->light_apart) add_splats(splats + EC_SPLAT_WORDS * (ulong)place, params->splat_unit, batch, out);
    if (params->apart) write_cut(radiance + 3 * (ulong)wave, batch, params->limit, out);
}

EC_KERNEL(ec_accumulate, LANES, ACCUMULATE_PARAMETERS, slot_entries(pixel_count, i))
{
    uint places[LANES];
    pixel_to_places(params, LANE_NUMBERS + (first_pixel + i), places);
    for (uint k = 0; k < min(left, (uint)LANES); k++) {
        ulong entry = pixel_list ? first_pixel + i + k : places[k];
        accumulate_one(params, radiance + (i + k) * params->batch, splats, places[k], batch_film + EC_BATCH_FIELDS * entry);
    }
}
