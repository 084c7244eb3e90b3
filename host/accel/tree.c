/* Facts about subtrees, and memory on cache lines. */
#include "accel/layout_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

ec_subtree *ec_bvh_subtrees(const ec_bvh *bvh)
{
    ec_subtree *subtrees = malloc(bvh->node_count * sizeof *subtrees);
    if (!subtrees) return NULL;
    for (uint32_t i = bvh->node_count; i-- > 0;) { /* children lie behind their parents */
        const ec_bvh_build_node *node = &bvh->nodes[i];
        if (!node->left) {
            subtrees[i] = (ec_subtree){.count = node->count};
            continue;
        }
        const ec_subtree *left = &subtrees[node->left], *right = left + 1;
        subtrees[i].count = left->count + right->count;
        subtrees[i].height = 1 + (left->height > right->height ? left->height : right->height);
    }
    return subtrees;
}

void *ec_allocate_lines(size_t count, size_t size)
{
    return ec_shared_alloc((count ? count : 1) * size);
}

int ec_reserve_lines(void *array, uint32_t *room, uint32_t used, uint64_t wanted, size_t size)
{
    void *old, *larger;
    if (wanted <= *room) return 1;
    const uint64_t count = wanted > 2 * (uint64_t)*room ? wanted : 2 * (uint64_t)*room;
    memcpy(&old, array, sizeof old);
    larger = ec_allocate_lines(count, size);
    if (!larger) return 0;
    if (used) memcpy(larger, old, used * size);
    free(old);
    memcpy(array, &larger, sizeof larger);
    *room = (uint32_t)count;
    return 1;
}
