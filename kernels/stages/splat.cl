/* Adds the light that shadow rays of light paths have brought to their slots to its pixels. Reads: the slots' radiance, which is zeroed, and pixels.
 * Writes: the splats. Sums are of whole numbers, so that no bit depends on the order; a fraction of a step is rounded up with a probability of its
 * size. Last stage of a bounce of light paths. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../lib/sampler.h"
#include "../shared/path_state.h"

/* Adds to a 64-bit sum of two words, for devices without 64-bit atomics: whoever makes the low word overflow carries. r: random bits by which `steps`
 * is rounded. */
static void add_fixed(volatile global uint *words, float steps, uint r)
{
    steps = min(steps, 1.8e19f);
    ulong whole = (ulong)steps;
    whole += (float)r * 2.3283064365386963e-10f < steps - (float)whole ? 1u : 0u;
    if (!whole) return;
    uint low = (uint)whole, high = (uint)(whole >> 32), before = atomic_add(words, low);
    high += before > 0xffffffffu - low ? 1u : 0u;
    if (high) atomic_add(words + 1, high);
}

#define SPLAT_PARAMETERS(DO)                                                                                                                          \
    DO(uint, seed) DO(uint, first_pixel) DO(uint, bounce) DO(uint, path_count) DO(global float *, radiance) DO(global const float *, light_slots)     \
    DO(volatile global uint *, splats)

EC_KERNEL(ec_splat, LANES, SPLAT_PARAMETERS, slot_entries(path_count, i))
{
    uint wave = params->wave;
    v3 light = queue_load_v3(radiance, wave, 0, i);
    uint bits = mask_bits((LANE_NUMBERS < left) & (v3_max_component(light) != 0.0f));
    for (uint rest = bits; rest; rest &= rest - 1u) {
        uint slot = i + 31u - clz(rest & (~rest + 1u));
        lane_u path, sample;
        float red = radiance[slot], green = radiance[wave + slot], blue = radiance[2 * wave + slot], y = luminance_one(red, green, blue);
        slot_to_pixel(params, first_pixel, 0, U(slot), &path, &sample);
        volatile global uint *words = splats + EC_SPLAT_WORDS * (ulong)as_uint(light_slots[EC_LIGHT_SLOT_PIXEL * wave + slot]);
        uint r = hash_scalar(hash_scalar(hash_scalar(LANE(path, 0)) ^ seed) + LANE(sample, 0) * 0x9e3779b9u + bounce);
        add_fixed(words + EC_SPLAT_R, red / params->splat_unit, r = hash_scalar(r));
        add_fixed(words + EC_SPLAT_G, green / params->splat_unit, r = hash_scalar(r));
        add_fixed(words + EC_SPLAT_B, blue / params->splat_unit, r = hash_scalar(r));
        if (is_finite_one(y)) atomic_max(words + EC_SPLAT_LARGEST, as_uint(y));
    }
    if (bits) queue_store_v3(radiance, wave, 0, i, v3_zero());
}
