/* Clips triangles against the camera's view until one is seen. */
#include "scene/in_sight.h"

#include <math.h>
#include <string.h>

#include "base/vec3.h"

enum { MOST = 9 }; /* corners of a triangle clipped by six planes */
typedef double corner[3]; /* components right, up, forward */

/* Returns how far inside a plane of the view a corner is. */
static double within(const corner c, int plane, bool is_flat, const double window[4])
{
    if (plane == 4) return c[2];
    const double bound = window[plane] * (is_flat ? 1 : c[2]);
    return plane % 2 ? bound - c[plane / 2] : c[plane / 2] - bound;
}

/* Clips the polygon at a plane (Sutherland and Hodgman 1974); returns the number of corners left. */
static int cut(corner *polygon, int count, int plane, bool is_flat, const double window[4])
{
    corner left[MOST];
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const double *a = polygon[i], *b = polygon[(i + 1) % count];
        const double of_a = within(a, plane, is_flat, window), of_b = within(b, plane, is_flat, window);
        if (of_a > 0) memcpy(left[kept++], a, sizeof(corner));
        if ((of_a > 0) == (of_b > 0) || kept == MOST) continue;
        for (int k = 0; k < 3; k++) left[kept][k] = a[k] + (b[k] - a[k]) * (of_a / (of_a - of_b));
        kept++;
    }
    memcpy(polygon, left, (size_t)kept * sizeof(corner));
    return kept;
}

static bool is_in_view(corner triangle[3], bool is_flat, const double window[4])
{
    corner polygon[MOST];
    int count = 3;
    memcpy(polygon, triangle, 3 * sizeof(corner));
    for (int plane = 4; plane >= 0 && count; plane--) count = cut(polygon, count, plane, is_flat, window);
    return count > 0;
}

static bool is_front(corner c[3], bool is_flat)
{
    double u[3], v[3], n[3];
    for (int k = 0; k < 3; k++) u[k] = c[1][k] - c[0][k], v[k] = c[2][k] - c[0][k];
    ec_cross(u, v, n);
    /* the camera's right, up and forward are a left-handed frame, where normals point the other way */
    return (is_flat ? n[2] : ec_dot(n, c[0])) > 0;
}

ec_in_sight ec_scene_in_sight(const ec_scene *s, const ec_camera *camera, const double window[4])
{
    const bool is_flat = camera->type == EC_CAMERA_ORTHOGRAPHIC;
    const float *const axes[3] = {camera->right, camera->up, camera->forward};
    ec_in_sight seen = EC_SIGHT_NONE;
    if (s->shape_count || s->motion.segments) return EC_SIGHT_FRONTS;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        corner c[3] = {{0}};
        for (int i = 0; i < 3; i++) {
            const float *p = s->positions + 3 * (size_t)s->indices[3 * (size_t)t + (size_t)i];
            for (int k = 0; k < 3; k++)
                for (int axis = 0; axis < 3; axis++) c[i][k] += ((double)p[axis] - camera->position[axis]) * axes[k][axis];
        }
        const bool shows = s->materials[s->triangle_material[t]].double_sided || is_front(c, is_flat);
        if (!shows && seen == EC_SIGHT_BACKS) continue;
        if (!is_in_view(c, is_flat, window)) continue;
        if (shows) return EC_SIGHT_FRONTS;
        seen = EC_SIGHT_BACKS;
    }
    return seen;
}
