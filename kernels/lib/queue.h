/* Reading and writing the queues, lane-wide. */
#ifndef EC_LIB_QUEUE_H
#define EC_LIB_QUEUE_H

#include "../shared/params.h"
#include "../shared/path_state.h"
#include "math.h"
#include "reserve.h"

/* Entries per work-item in kernels that take one entry at a time. */
#ifndef RUN
#define RUN 1u
#endif
/* Returns the first of the `takes` entries of work-item `item` in part `row`; EC_NO_ID past the end of the part. */
EC_INLINED uint queue_entry(uint part, uint row, uint item, uint takes)
{
    uint before = item * takes;
    return before < part ? row * part + before : EC_NO_ID;
}
/* Returns how many entries there are from i on: of a queue in part `row`, which holds i; slot_entries: of all slots. */
EC_INLINED uint queue_entries(global const uint *counts, uint wave, uint part, uint row, uint i)
{
    if (i >= wave) return 0u;
    uint before = i - row * part, count = counts[row * EC_PART_STRIDE];
    return count > before ? count - before : 0u;
}
EC_INLINED uint slot_entries(uint count, uint i) { return i < count ? count - i : 0u; }
/* Neighbouring entries that one work-item puts in order, where it does. */
#define EC_ORDERED 1024u
/* Returns how many of the `left` entries from i on a work-item takes that puts them in order: up to EC_ORDERED, or none between their first ones. */
EC_INLINED uint ordered_entries(uint left, uint part, uint i) { return i % part % EC_ORDERED ? 0u : min(left, EC_ORDERED); }
/* Reserves room in part `row` for the lanes of `bits`, of which there is at least one; returns the first entry. */
EC_FN uint queue_reserve(volatile global uint *counts, uint part, uint row, uint bits)
{
    volatile global uint *counter = &counts[row * EC_PART_STRIDE];
#if LANES == 1
    return row * part + reserve_place(counter);
#else
    return row * part + atomic_add(counter, popcount(bits));
#endif
}

EC_FN lane_f queue_load_f(global const float *queue, uint wave, uint field, uint i)
{
    return *(global const lane_f_words *)(queue + field * wave + i);
}
EC_FN lane_u queue_load_u(global const float *queue, uint wave, uint field, uint i)
{
    return as_lane_u(queue_load_f(queue, wave, field, i));
}
EC_FN v3 queue_load_v3(global const float *queue, uint wave, uint field, uint i)
{
    return v3_make(queue_load_f(queue, wave, field, i), queue_load_f(queue, wave, field + 1, i),
                   queue_load_f(queue, wave, field + 2, i));
}
/* LANES entries of a queue: consecutive from `first` on or, if is_scattered, those numbered `at`. */
typedef struct queue_packet {
    uint first;
    bool is_scattered;
    lane_u at;
} queue_packet;
EC_INLINED lane_f packet_load_f(global const float *queue, uint wave, uint field, const queue_packet *q)
{
    return q->is_scattered ? gather_f(queue + field * wave, q->at) : queue_load_f(queue, wave, field, q->first);
}
EC_INLINED lane_u packet_load_u(global const float *queue, uint wave, uint field, const queue_packet *q)
{
    return as_lane_u(packet_load_f(queue, wave, field, q));
}
EC_INLINED v3 packet_load_v3(global const float *queue, uint wave, uint field, const queue_packet *q)
{
    return v3_make(packet_load_f(queue, wave, field, q), packet_load_f(queue, wave, field + 1, q),
                   packet_load_f(queue, wave, field + 2, q));
}
EC_FN void queue_store_f(global float *queue, uint wave, uint field, uint i, lane_f v)
{
    *(global lane_f_words *)(queue + field * wave + i) = v;
}
EC_FN void queue_store_v3(global float *queue, uint wave, uint field, uint i, v3 v)
{
    queue_store_f(queue, wave, field, i, v.x);
    queue_store_f(queue, wave, field + 1, i, v.y);
    queue_store_f(queue, wave, field + 2, i, v.z);
}
EC_INLINED void packet_store_f(global float *queue, uint wave, uint field, const queue_packet *q, lane_f v, uint bits)
{
    if (q->is_scattered) scatter_f(queue + field * wave, q->at, v, bits);
    else queue_store_f(queue, wave, field, q->first, v);
}
/* Appends the lanes of `bits` at i, i + 1, … */
EC_FN void queue_push_f(global float *queue, uint wave, uint field, uint i, lane_f v, uint bits)
{
    store_compact(queue + field * wave + i, v, bits);
}
EC_FN void queue_push_v3(global float *queue, uint wave, uint field, uint i, v3 v, uint bits)
{
    queue_push_f(queue, wave, field, i, v.x, bits);
    queue_push_f(queue, wave, field + 1, i, v.y, bits);
    queue_push_f(queue, wave, field + 2, i, v.z, bits);
}

/* Returns where light of paths with so many segments is added, by slot: R, G, B of direct light, or those of indirect light behind them where it is
 * kept apart. */
EC_FN global float *radiance_of(constant ec_params *params, global float *radiance, uint segments)
{
    return params->apart && segments > EC_DIRECT_SEGMENTS ? radiance + 3 * (ulong)params->wave : radiance;
}

/* Adds light to the samples' slots; what is not finite is dropped and counted. */
EC_FN void radiance_add(global float *radiance, uint wave, lane_u slot, v3 light, lane_i m, volatile global uint *invalid)
{
    lane_i finite = v3_is_finite(light);
    uint bad = mask_bits(m & !finite);
    if (bad) atomic_add(invalid, popcount(bad));
    uint bits = mask_bits(m & finite);
    scatter_add_3(radiance, wave, slot, light.x, light.y, light.z, bits);
}

#endif
