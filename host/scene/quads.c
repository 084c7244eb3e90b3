/* Most meshes are quads cut in two. Neighbours in the list that share an edge are rotated to (p, q, r) and (p, r, s), so that later steps recognise a
 * quad by comparing two vertices. Rotation preserves winding, normals and interpolation. */
#include <string.h>

#include "scene/validate.h"

static bool is_same_point(const ec_scene *s, uint32_t a, uint32_t b)
{
    return a == b || !memcmp(s->positions + 3 * (size_t)a, s->positions + 3 * (size_t)b, 3 * sizeof(float));
}

static void rotate(uint32_t *corner, int by)
{
    uint32_t old[3] = {corner[0], corner[1], corner[2]};
    for (int k = 0; k < 3; k++) corner[k] = old[(k + by) % 3];
}

/* Rotates both if edge i -> i + 1 of one is edge j + 1 -> j of the other. */
static bool join(const ec_scene *s, uint32_t *first, uint32_t *second)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (!is_same_point(s, first[i], second[(j + 1) % 3]) || !is_same_point(s, first[(i + 1) % 3], second[j])) continue;
            rotate(first, (i + 1) % 3); /* the shared edge becomes r -> p */
            rotate(second, j);          /* here it becomes p -> r */
            return true;
        }
    return false;
}

void ec_scene_join_quads(ec_scene *s)
{
    for (uint32_t t = 0; t + 1 < s->triangle_count; t++)
        if (join(s, s->indices + 3 * (size_t)t, s->indices + 3 * (size_t)(t + 1))) t++;
}
