/* Each triangle is looked up once in a hash table of those met so far. */
#include "pack/coincident.h"

#include <string.h>

#include "base/freed.h"

typedef struct corners {
    float v[3][3];
} corners;

static int compare(const float *a, const float *b)
{
    return memcmp(a, b, 3 * sizeof *a);
}

static void swap(float *a, float *b)
{
    float old[3];
    memcpy(old, a, sizeof old);
    memcpy(a, b, sizeof old);
    memcpy(b, old, sizeof old);
}

/* Returns the corners in an order that is the same for all orders that mean the same emitter. */
static corners corners_of(const ec_prim *p)
{
    corners c;
    memcpy(c.v[0], p->v0, sizeof c.v[0]);
    memcpy(c.v[1], p->v1, sizeof c.v[1]);
    memcpy(c.v[2], p->v2, sizeof c.v[2]);
    for (int k = 0; k < 9; k++) c.v[k / 3][k % 3] += 0.0f; /* -0 becomes 0 */
    for (int k = 0; k < 2; k++)
        if (compare(c.v[1], c.v[0]) < 0 || compare(c.v[2], c.v[0]) < 0) { /* rotating keeps the front */
            swap(c.v[0], c.v[1]);
            swap(c.v[1], c.v[2]);
        }
    return c;
}

static uint64_t hash_of(const corners *c)
{
    uint64_t hash = 0;
    for (int k = 0; k < 9; k++) {
        uint32_t word;
        memcpy(&word, &c->v[k / 3][k % 3], sizeof word);
        hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 29;
    }
    return hash;
}

static bool is_two_sided(const ec_scene *scene, const ec_prim *p)
{
    return scene->materials[p->material].double_sided;
}

/* Returns the first equal triangle. table: triangle + 1, or 0 if free; its size is a power of two. */
static uint32_t find_or_add(const ec_scene *scene, const ec_pack *pack, uint32_t *table, uint64_t mask, uint32_t prim)
{
    const ec_prim *p = &pack->prims[prim];
    bool two_sided = is_two_sided(scene, p);
    corners own = corners_of(p);
    for (uint64_t at = hash_of(&own) & mask;; at = (at + 1) & mask) {
        if (!table[at]) {
            table[at] = prim + 1;
            return prim;
        }
        const ec_prim *q = &pack->prims[table[at] - 1];
        if (is_two_sided(scene, q) != two_sided) continue;
        corners other = corners_of(q);
        if (!memcmp(&own, &other, sizeof own)) return table[at] - 1;
    }
}

ec_result ec_coincident_find(const ec_scene *scene, const ec_pack *pack, const bool *emits, uint32_t **first, ec_error *err)
{
    uint64_t count = 0, size = 16;
    const uint32_t moving = scene->motion.segments ? scene->motion.triangle_count : 0;
    for (uint32_t p = 0; p < pack->prim_count; p++) count += emits[pack->prims[p].material];
    while (size < 2 * count) size *= 2;
    EC_FREED uint32_t *table = calloc(size, sizeof *table);
    *first = malloc(((size_t)pack->prim_count + 1) * sizeof **first);
    if (!table || !*first) return ec_fail(err, "out of memory for %llu emitting triangles", (unsigned long long)count);
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (p < moving) (*first)[p] = p; /* moving triangles may part */
        else if (emits[pack->prims[p].material]) (*first)[p] = find_or_add(scene, pack, table, size - 1, p);
    return EC_OK;
}
