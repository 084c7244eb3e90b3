/* Rays for bench_traversal: the same ones for Embree and for eclat. */
#ifndef EC_BENCH_RAYS_H
#define EC_BENCH_RAYS_H

#include <stdint.h>

#include "bench_build_mesh.h"

typedef struct bench_ray {
    float o[3], d[3]; /* d need not be unit */
    float t_max;      /* in lengths of d */
    uint32_t leaves;  /* the triangle it comes from, which eclat's rays ignore; UINT32_MAX: none */
} bench_ray;

typedef struct bench_hit {
    uint32_t prim; /* UINT32_MAX: none */
    float t;       /* in lengths of d */
} bench_hit;

typedef enum bench_kind { BENCH_CAMERA, BENCH_BOUNCE, BENCH_SHADOW, BENCH_KIND_COUNT } bench_kind;

typedef struct bench_rays {
    bench_ray *rays;
    uint32_t count;
} bench_rays;

/* Moves the mesh so that its bounding box is centred, as eclat does with every scene. Returns the largest |coordinate|. */
float bench_recentre(bench_mesh *mesh);

/* size x size pixels in tiles of 8 x 8; from inside the bounding box, as in the traversal sketch. NULL rays: no memory. */
bench_rays bench_camera_rays(const bench_mesh *mesh, uint32_t size);
/* One cosine-distributed ray from every hit, in the order of the camera rays. */
bench_rays bench_bounce_rays(const bench_mesh *mesh, const bench_rays *camera, const bench_hit *hits);
/* The same rays, ended after 0.3 diagonals of the scene, as d with t in (0, 1). */
bench_rays bench_shadow_rays(const bench_mesh *mesh, const bench_rays *bounce);

/* Seconds: of the wall clock, or, where others use the machine too, of processor time spent by this process. */
double bench_clock(void);
void bench_clock_use_cpu_time(void);

#endif
