/* Reserving places in a queue, one for each work-item of a kernel of one lane. */
#ifndef EC_LIB_RESERVE_H
#define EC_LIB_RESERVE_H

#include "../shared/types.h"

/* Returns the work-item's place: a number that no other gets; together they have no gaps. With SUBGROUPS (host/cl/workarounds.h) the work-items of a
 * sub-group that call this together, which may be any of them, must have the same counter: the first adds for all, the others count how many
 * come before them. A compiler for OpenCL C 1.2 that has these functions says so by the extension's macro; without it each work-item adds 1. */
EC_FN uint reserve_place(volatile global uint *counter)
{
#if defined(SUBGROUPS) && defined(cl_khr_subgroup_ballot)
    uint4 here = sub_group_ballot(1);
    uint before = sub_group_ballot_exclusive_scan(here), first = 0u;
    if (before == 0u) first = atomic_add(counter, sub_group_ballot_bit_count(here));
    return sub_group_broadcast_first(first) + before;
#else
    return atomic_add(counter, 1u);
#endif
}

#endif
