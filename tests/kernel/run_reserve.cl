/* Places in queues, for test_reserve.c. With EMULATED, work-items have sub-groups of 32 on any device: all of a group go through the reservation in
 * step, and functions made of barriers stand for those of a sub-group. They take the work-items that reserve nothing for absent. */
#include "lib/lanes.h"
#include "shared/path_state.h"

#ifdef EMULATED
#define SIZE 32u /* of a sub-group */
#define ROOM 1024u /* words between two groups' notes, which come after the counters: which work-items reserve, and what the first of a sub-group tells the others */
#define NOTES(counter) ((counter) + ROOM * (1u + (uint)get_group_id(0)))
#define TOLD 64u

static uint my_lane(void) { return (uint)get_local_id(0) % SIZE; }
static uint my_group(void) { return (uint)get_local_id(0) / SIZE; }
static uint4 ballot(volatile global uint *notes)
{
    uint bits = 0u;
    for (uint i = 0; i < SIZE; i++) bits |= notes[my_group() * SIZE + i] << i;
    return (uint4)(bits, 0u, 0u, 0u);
}
/* Not 0 for an absent work-item, which must not add. */
static uint bits_before(uint4 bits)
{
    return bits.x >> my_lane() & 1u ? popcount(bits.x & ((1u << my_lane()) - 1u)) : 1u;
}
static uint told(volatile global uint *notes, uint value)
{
    const uint here = ballot(notes).x;
    if (here && my_lane() == 31u - clz(here & (~here + 1u))) notes[TOLD + my_group()] = value;
    barrier(CLK_GLOBAL_MEM_FENCE);
    return notes[TOLD + my_group()];
}
#undef cl_khr_subgroup_ballot
#define cl_khr_subgroup_ballot 1
#define sub_group_ballot(is) ballot(NOTES(counter))
#define sub_group_ballot_exclusive_scan(bits) bits_before(bits)
#define sub_group_ballot_bit_count(bits) popcount((bits).x)
#define sub_group_broadcast_first(value) told(NOTES(counter), value)
#endif

/* Adds to a counter, and counts the additions in the word after it. */
static uint counted_add(volatile global uint *counter, uint n)
{
    atomic_inc(counter + 1);
    return atomic_add(counter, n);
}
#undef atomic_add /* PoCL's is a macro */
#define atomic_add counted_add
#include "lib/queue.h"

/* Work-item i reserves asks[i] places, one in each round, of the part of its group. joins: whether sub-groups are in use. */
kernel void reserve(volatile global uint *counters, global const uint *asks, uint part, uint rows, uint rounds, global uint *places, global uint *joins)
{
    const uint i = (uint)get_global_id(0), row = (uint)get_group_id(0) % rows;
#if defined(SUBGROUPS) && defined(cl_khr_subgroup_ballot)
    if (i == 0u) *joins = 1u;
#endif
    for (uint k = 0; k < rounds; k++) {
#ifdef EMULATED
        NOTES(counters + row * EC_PART_STRIDE)[get_local_id(0)] = asks[i] > k;
        barrier(CLK_GLOBAL_MEM_FENCE);
        const uint place = queue_reserve(counters, part, row, 1u);
        if (asks[i] > k) places[i * rounds + k] = place;
        barrier(CLK_GLOBAL_MEM_FENCE);
#else
        if (asks[i] > k) places[i * rounds + k] = queue_reserve(counters, part, row, 1u);
#endif
    }
}
