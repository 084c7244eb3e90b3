/* The stack of a traversal of the binary BVH: nodes left for later. Packets keep all of them.
 *
 * A single ray keeps the last few, and a trail: one bit a level, set where the first child is done, because the ray is in the second or met only one
 * (Laine 2010, "Restart Trail for Stackless BVH Traversal"). On a graphics card each ray has a stack of its own, and those of all rays in flight
 * compete for its caches. To go on, a bit is added at the parent's level: the carry runs up past the levels that are done. Where the entry is no
 * longer held, the ray starts at the root again and follows the trail. For that, children have an order that stays the same: by where the ray enters
 * their boxes, whatever hit it has found. If a box is culled meanwhile, a subtree may be entered again that is done, but none of its triangles is
 * taken again. Trees are at most EC_DEPTH_MAX, 63, edges deep (host/accel/build_internal.h). */
#ifndef EC_LIB_STACK_BVH2_H
#define EC_LIB_STACK_BVH2_H

#include "../shared/accel.h"
#include "lanes.h"

#if LANES == 1
#ifndef STACK_ENTRIES
#define STACK_ENTRIES 24u /* a ring buffer */
#endif

typedef struct bvh2_stack {
    uint *entries; /* outside of it: compilers keep a struct in memory if an array in it has an index that is not constant */
    uint top, held;
    uint below;  /* levels below the one the ray is at: 63 at the root */
    ulong trail; /* the root's bit is the highest */
} bvh2_stack;

EC_FN void stack_start(bvh2_stack *s, uint *entries)
{
    s->entries = entries;
    s->top = s->held = 0u;
    s->below = 63u;
    s->trail = 0ul;
}

/* Enters the only child that is met. */
EC_FN void stack_one(bvh2_stack *s)
{
    s->trail |= 1ul << s->below;
    s->below--;
}

/* Returns which of two children to enter, where both are met. */
EC_FN uint stack_both(bvh2_stack *s, uint first, uint second)
{
    bool is_left = s->trail >> s->below & 1ul;
    s->below--;
    if (is_left) return second;
    s->entries[s->top] = second;
    s->top = s->top + 1u < STACK_ENTRIES ? s->top + 1u : 0u;
    s->held += s->held < STACK_ENTRIES ? 1u : 0u;
    return first;
}

/* Goes on to the next node that is left; returns false if there is none. */
EC_FN bool stack_next(bvh2_stack *s, uint *current)
{
    if (s->below == 63u) return false; /* no child of the root was met */
    ulong parent = 2ul << s->below;
    s->trail = (s->trail & -parent) + parent;
    if (!s->trail) return false;
    if (s->held) {
        s->held--;
        s->top = s->top ? s->top - 1u : STACK_ENTRIES - 1u;
        *current = s->entries[s->top];
        s->below = 62u - (uint)clz(s->trail & -s->trail);
    } else {
        *current = 0u;
        s->below = 63u;
    }
    return true;
}

#else
#define STACK_ENTRIES EC_BVH_STACK

typedef struct bvh2_stack {
    uint *entries;
    uint top;
} bvh2_stack;

EC_FN void stack_start(bvh2_stack *s, uint *entries)
{
    s->entries = entries;
    s->top = 0;
}
EC_FN void stack_one(bvh2_stack *s) {}
EC_FN uint stack_both(bvh2_stack *s, uint first, uint second)
{
    s->entries[s->top++] = second;
    return first;
}
EC_FN bool stack_next(bvh2_stack *s, uint *current)
{
    if (s->top == 0) return false;
    *current = s->entries[--s->top];
    return true;
}
#endif

#endif
