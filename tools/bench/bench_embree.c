#include "bench_embree.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif


#define CHUNK 4096

struct bench_embree {
    RTCDevice device;
    RTCScene scene;
    int threads;
};

bench_embree *bench_embree_create(const bench_mesh *mesh, int threads, bool robust)
{
    bench_embree *e = calloc(1, sizeof *e);
    char config[64];
    snprintf(config, sizeof config, "threads=%d", threads);
    e->threads = threads;
    e->device = rtcNewDevice(config);
    if (!e->device) return NULL;
    e->scene = rtcNewScene(e->device);
    if (robust) rtcSetSceneFlags(e->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(e->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                               mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                                mesh->triangle_count);
    if (!positions || !indices) return NULL;
    memcpy(positions, mesh->positions, 12 * (size_t)mesh->vertex_count);
    memcpy(indices, mesh->indices, 12 * (size_t)mesh->triangle_count);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(e->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(e->scene);
    return e;
}

void bench_embree_destroy(bench_embree *e)
{
    if (!e) return;
    rtcReleaseScene(e->scene);
    rtcReleaseDevice(e->device);
    free(e);
}

static struct RTCRay ray_of(const bench_ray *from)
{
    return (struct RTCRay){.org_x = from->o[0], .org_y = from->o[1], .org_z = from->o[2],
                           .dir_x = from->d[0], .dir_y = from->d[1], .dir_z = from->d[2],
                           .tfar = from->t_max, .mask = 0xffffffffu};
}

static void trace_chunk(const bench_embree *e, const bench_rays *rays, bench_hit *hits, uint32_t begin, bool any)
{
    uint32_t end = rays->count - begin < CHUNK ? rays->count : begin + CHUNK;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint32_t i = begin; i < end; i++) {
        struct RTCRayHit q = {.ray = ray_of(&rays->rays[i]),
                              .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
        if (any) {
            rtcOccluded1(e->scene, &context, &q.ray);
            hits[i] = (bench_hit){q.ray.tfar < 0.0f ? 0 : UINT32_MAX, 0.0f};
        } else {
            rtcIntersect1(e->scene, &context, &q);
            hits[i] = (bench_hit){q.hit.geomID == RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : q.hit.primID, q.ray.tfar};
        }
    }
}

static double trace(const bench_embree *e, const bench_rays *rays, bench_hit *hits, bool any)
{
    double start = bench_clock();
#pragma omp parallel num_threads(e->threads)
    {
#ifdef __SSE2__
        unsigned state = _mm_getcsr();
        _mm_setcsr(state | 0x8040); /* no denormals, as Embree's manual advises */
#endif
#pragma omp for schedule(dynamic, 1)
        for (uint32_t begin = 0; begin < rays->count; begin += CHUNK) trace_chunk(e, rays, hits, begin, any);
#ifdef __SSE2__
        _mm_setcsr(state);
#endif
    }
    return bench_clock() - start;
}

double bench_embree_closest(const bench_embree *e, const bench_rays *rays, bench_hit *hits)
{
    return trace(e, rays, hits, false);
}
double bench_embree_any(const bench_embree *e, const bench_rays *rays, bench_hit *hits)
{
    return trace(e, rays, hits, true);
}
