/* A point of a matt floor, and the light of a polygon on it in closed form. */
#ifndef EC_TESTS_SUPPORT_FLOOR_CASE_H
#define EC_TESTS_SUPPORT_FLOOR_CASE_H

#include "report/names.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

#define PI 3.14159265358979323846

enum { SKILLED = 7, ALL = 15 }; /* uniform directions are noisier than most checks here allow */

/* Renders the view of a camera with a tiny field of view (8 x 8 pixels of one point). */
static inline void check_point(const char *path, const char *environment, double expected, int samples, uint32_t spp, double most_se)
{
    ec_scene *scene = case_load(path, environment);
    for (int s = 0; s <= EC_SAMPLE_HEMISPHERE; s++) {
        if (!(samples >> s & 1)) continue;
        ec_render_options o = case_options(8, 8, spp);
        o.max_depth = 2;
        o.sample = (ec_sample)s;
        o.seed = 7;
        case_image image = case_render(scene, &o);
        printf("%-40s %-4s %.7f +- %.7f, expected %.7f\n", strrchr(path, '/') + 1, ec_sample_names[s], image.mean[1],
               image.mean_se[1], expected);
        CASE_NEAR(&image, expected, 4.5, most_se);
        case_free(&image);
    }
    ec_scene_free(scene);
}

/* Lambert 1760: irradiance / radiance of a polygon above the horizon is half the sum over edges of the angle that an edge subtends, times
 * the cosine between the normal and that of the edge's plane. */
static inline double lambert(const double (*p)[3], int count, const double normal[3])
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        double sine = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        sum += atan2(sine, cosine) * (c[0] * normal[0] + c[1] * normal[1] + c[2] * normal[2]) / sine;
    }
    return fabs(0.5 * sum);
}

static const double up[3] = {0, 1, 0};

/* A floor of albedo 0.6 around the origin, seen from just beside the normal at a height below everything else. */
static inline gltf_writer *floor_scene(double camera_height)
{
    gltf_writer *w = gltf_new();
    int grey = gltf_lambert(w, 0.6, 0);
    gltf_quad(w, grey, (double[3]){-3, 0, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
    gltf_camera(w, (double[3]){0, camera_height, 0}, (double[3]){0, 0, 0}, 1e-5);
    return w;
}

#endif
