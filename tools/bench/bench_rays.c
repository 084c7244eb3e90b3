/* Camera, bounce and shadow rays as in prototypes/traversal, but from a hash instead of a running state. */
#include "bench_rays.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"

static bool is_cpu_time;
void bench_clock_use_cpu_time(void) { is_cpu_time = true; }
double bench_clock(void)
{
    struct timespec t;
    if (!is_cpu_time || clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t)) return ec_now();
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void bounds(const bench_mesh *mesh, float lo[3], float hi[3])
{
    for (int k = 0; k < 3; k++) lo[k] = INFINITY, hi[k] = -INFINITY;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            float x = mesh->positions[3 * (size_t)i + k];
            lo[k] = fminf(lo[k], x), hi[k] = fmaxf(hi[k], x);
        }
}

float bench_recentre(bench_mesh *mesh)
{
    float lo[3], hi[3], largest = 0.0f;
    bounds(mesh, lo, hi);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            float *x = &mesh->positions[3 * (size_t)i + k];
            *x = (float)(*x - 0.5 * ((double)lo[k] + hi[k]));
            largest = fmaxf(largest, fabsf(*x));
        }
    return largest;
}

static uint32_t hash(uint32_t x)
{
    x ^= x >> 16, x *= 0x21f0aaadu, x ^= x >> 15, x *= 0x735a2d97u, x ^= x >> 15;
    return x;
}
static float unit(uint32_t x) { return (float)(hash(x) >> 8) * 0x1p-24f; }

static void normalize(float v[3])
{
    float s = 1.0f / sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) v[k] *= s;
}

bench_rays bench_camera_rays(const bench_mesh *mesh, uint32_t size)
{
    size = (size + 7) / 8 * 8;
    bench_rays r = {malloc((size_t)size * size * sizeof(bench_ray)), size * size};
    if (!r.rays) return r;
    float lo[3], hi[3];
    bounds(mesh, lo, hi);
    static const float place[3] = {0.02f, 0.05f, -0.45f}; /* of the extent, from the centre */
    for (uint32_t i = 0; i < r.count; i++) {
        uint32_t tile = i / 64, in_tile = i % 64, tiles = size / 8;
        uint32_t x = tile % tiles * 8 + in_tile % 8, y = tile / tiles * 8 + in_tile / 8;
        bench_ray *ray = &r.rays[i];
        ray->d[0] = ((float)x + 0.5f) / (float)size * 2.0f - 1.0f;
        ray->d[1] = 1.0f - ((float)y + 0.5f) / (float)size * 2.0f;
        ray->d[2] = 1.2f;
        normalize(ray->d);
        for (int k = 0; k < 3; k++) ray->o[k] = 0.5f * (lo[k] + hi[k]) + place[k] * (hi[k] - lo[k]);
        ray->t_max = 3.0e38f;
        ray->leaves = UINT32_MAX;
    }
    return r;
}

static void face_normal(const bench_mesh *mesh, uint32_t prim, const float d[3], float n[3])
{
    const float *v[3];
    for (int k = 0; k < 3; k++) v[k] = mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)prim + k];
    float a[3], b[3];
    for (int k = 0; k < 3; k++) a[k] = v[1][k] - v[0][k], b[k] = v[2][k] - v[0][k];
    for (int k = 0; k < 3; k++) n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    normalize(n);
    if (n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0.0f)
        for (int k = 0; k < 3; k++) n[k] = -n[k];
}

bench_rays bench_bounce_rays(const bench_mesh *mesh, const bench_rays *camera, const bench_hit *hits)
{
    bench_rays r = {malloc((size_t)camera->count * sizeof(bench_ray) + 1), 0};
    if (!r.rays) return r;
    float lo[3], hi[3];
    bounds(mesh, lo, hi);
    float offset = 1e-4f * fmaxf(hi[0] - lo[0], fmaxf(hi[1] - lo[1], hi[2] - lo[2])) * 0.5f;
    for (uint32_t i = 0; i < camera->count; i++) {
        const bench_ray *from = &camera->rays[i];
        if (hits[i].prim == UINT32_MAX) continue;
        float n[3], s[3];
        face_normal(mesh, hits[i].prim, from->d, n);
        if (!isfinite(n[0] + n[1] + n[2])) continue;
        /* A point on the unit sphere around n's tip is distributed as the cosine. */
        float z = 1.0f - 2.0f * unit(2 * i), phi = 6.2831853f * unit(2 * i + 1), rho = sqrtf(fmaxf(0.0f, 1.0f - z * z));
        s[0] = rho * cosf(phi), s[1] = rho * sinf(phi), s[2] = z;
        bench_ray *ray = &r.rays[r.count++];
        for (int k = 0; k < 3; k++) ray->d[k] = n[k] + 0.999f * s[k];
        normalize(ray->d);
        for (int k = 0; k < 3; k++) ray->o[k] = from->o[k] + from->d[k] * hits[i].t + n[k] * offset;
        ray->t_max = 3.0e38f;
        ray->leaves = hits[i].prim;
    }
    return r;
}

bench_rays bench_shadow_rays(const bench_mesh *mesh, const bench_rays *bounce)
{
    bench_rays r = {malloc((size_t)bounce->count * sizeof(bench_ray) + 1), bounce->count};
    if (!r.rays) return r;
    float lo[3], hi[3], diagonal = 0.0f;
    bounds(mesh, lo, hi);
    for (int k = 0; k < 3; k++) diagonal += (hi[k] - lo[k]) * (hi[k] - lo[k]);
    float length = 0.3f * sqrtf(diagonal);
    for (uint32_t i = 0; i < r.count; i++) {
        r.rays[i] = bounce->rays[i];
        for (int k = 0; k < 3; k++) r.rays[i].d[k] *= length;
        r.rays[i].t_max = 1.0f;
    }
    return r;
}
