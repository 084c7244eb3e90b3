/* Embree 3 on the rays of bench_rays.h, one ray a call. */
#ifndef EC_BENCH_EMBREE_H
#define EC_BENCH_EMBREE_H

#include <stdbool.h>

#include "bench_rays.h"

typedef struct bench_embree bench_embree;

/* Medium quality. robust: RTC_SCENE_FLAG_ROBUST, the watertight variant. NULL on failure. */
bench_embree *bench_embree_create(const bench_mesh *mesh, int threads, bool robust);
void bench_embree_destroy(bench_embree *embree);

/* rtcIntersect1. Returns seconds. */
double bench_embree_closest(const bench_embree *embree, const bench_rays *rays, bench_hit *hits);
/* rtcOccluded1; prim 0: something is in the way, UINT32_MAX: nothing. */
double bench_embree_any(const bench_embree *embree, const bench_rays *rays, bench_hit *hits);

#endif
