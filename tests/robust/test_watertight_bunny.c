/* tier: quick */
/* A scanned mesh seen from inside, with its holes closed: no ray leaves it in any accelerator. */
#include <math.h>
#include <unistd.h>

#include "base/vec3.h"
#include "kernel/kernel_run.h"
#include "selftest/tracer.h"

#define BUNNY ECLAT_SHARED "/assets/classic/meshes/mitsuba/bunny.ply"

typedef struct mesh {
    uint32_t points, faces;
    float *at;        /* 3 floats a point; room for one more point */
    uint32_t *corner; /* 3 indices a face; room for as many faces again */
} mesh;

/* Reads only the binary PLY of this file: points of three floats, faces of three corners. */
static bool read_mesh(const char *path, mesh *m)
{
    char line[128];
    FILE *file = fopen(path, "rb");
    *m = (mesh){0};
    while (file && fgets(line, sizeof line, file) && strcmp(line, "end_header\n")) {
        sscanf(line, "element vertex %u", &m->points);
        sscanf(line, "element face %u", &m->faces);
    }
    m->at = calloc(3 * ((size_t)m->points + 1), sizeof *m->at);
    m->corner = calloc(6 * (size_t)m->faces + 1, sizeof *m->corner);
    bool good = file && m->at && m->corner && fread(m->at, 12, m->points, file) == m->points;
    for (uint32_t i = 0; i < m->faces && good; i++) good = fgetc(file) == 3 && fread(m->corner + 3 * (size_t)i, 12, 1, file) == 1;
    if (file) fclose(file);
    return good;
}

static int by_key(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Adds a cone over all edges that have no neighbour, to one common point. Every rim point has as many edges in as out, so that the cones'
 * sides cancel. */
static uint32_t close_holes(mesh *m)
{
    uint32_t edges = 3 * m->faces, faces = m->faces, rim = 0;
    uint64_t *keys = malloc(edges * sizeof *keys);
    double sum[3] = {0};
    for (uint32_t i = 0; i < edges; i++) keys[i] = (uint64_t)m->corner[i] << 32 | m->corner[i % 3 == 2 ? i - 2 : i + 1];
    qsort(keys, edges, sizeof *keys, by_key);
    for (uint32_t i = 0; i < edges && m->faces < 2 * faces; i++) {
        uint32_t a = (uint32_t)(keys[i] >> 32), b = (uint32_t)keys[i];
        uint64_t other = (uint64_t)b << 32 | a;
        if (bsearch(&other, keys, edges, sizeof *keys, by_key)) continue;
        uint32_t *corner = m->corner + 3 * (size_t)m->faces++;
        corner[0] = b, corner[1] = a, corner[2] = m->points;
        for (int k = 0; k < 3; k++) sum[k] += m->at[3 * (size_t)a + k];
        rim++;
    }
    for (int k = 0; k < 3 && rim; k++) m->at[3 * (size_t)m->points + k] = (float)(sum[k] / rim);
    free(keys);
    return rim;
}

/* How often the surface winds around p: the sum of solid angles (van Oosterom and Strackee 1983). */
static double winding(const ec_soup *soup, const float p[3])
{
    double sum = 0;
    for (uint32_t i = 0; i < soup->count; i++) {
        double v[3][3], length[3], cross[3];
        for (int k = 0; k < 9; k++) v[k / 3][k % 3] = (double)soup->vertices[9 * (size_t)i + (size_t)k] - p[k % 3];
        for (int k = 0; k < 3; k++) length[k] = sqrt(ec_dot(v[k], v[k]));
        for (int k = 0; k < 3; k++) cross[k] = v[1][(k + 1) % 3] * v[2][(k + 2) % 3] - v[1][(k + 2) % 3] * v[2][(k + 1) % 3];
        sum += 2 * atan2(ec_dot(v[0], cross), length[0] * length[1] * length[2] + ec_dot(v[0], v[1]) * length[2] +
                                                  ec_dot(v[1], v[2]) * length[0] + ec_dot(v[2], v[0]) * length[1]);
    }
    return sum / (4 * 3.14159265358979323846);
}

enum { ORIGINS = 8 };

static void find_origins(const ec_soup *soup, uint64_t *random, float origins[ORIGINS][3])
{
    for (int found = 0, tried = 0; found < ORIGINS && tried < 1000; tried++) {
        const float *a = soup->vertices + 9 * (ec_random_bits(random) % soup->count), *b = soup->vertices + 9 * (ec_random_bits(random) % soup->count);
        for (int k = 0; k < 3; k++) origins[found][k] = 0.5f * (a[k] + b[k]);
        found += fabs(winding(soup, origins[found])) > 0.5;
        CHECK_MSG(tried < 999, "only %d points within", found);
    }
}

static void put_rays(ec_tracer *r, uint64_t *random, float origins[ORIGINS][3])
{
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
        const float *v = ec_tracer_triangle(r, (uint32_t)(ec_random_bits(random) % r->soup->count)), *o = origins[i % ORIGINS];
        double a = i % 5 < 2 ? 0 : ec_random_unit(random), b = i % 5 < 4 ? 0 : ec_random_unit(random) * (1 - a), from[3], to[3];
        float d[3];
        for (int k = 0; k < 3; k++) {
            from[k] = o[k];
            to[k] = v[k] + a * ((double)v[3 + k] - v[k]) + b * ((double)v[6 + k] - v[k]);
        }
        ec_float_direction(from, to, d);
        ec_tracer_ray(r, i, o, d, EC_NO_ID);
    }
}

static void trace_all(ec_selftest *t, const ec_soup *soup)
{
    float origins[ORIGINS][3];
    uint64_t random = 1;
    ec_tracer *r;
    ec_error err = {0};
    find_origins(soup, &random, origins);
    CHECK_OK(ec_tracer_of(t, &r, &err), err);
    if (!test_failures) CHECK_OK(ec_tracer_build(r, soup, &err), err);
    for (int run = 0; run < 8 && !test_failures; run++) {
        put_rays(r, &random, origins);
        for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
            if (!ec_tracer_has(r, a)) continue;
            uint32_t out = 0;
            CHECK_OK(ec_tracer_trace(r, a, EC_TRACER_RAYS, &err), err);
            for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) out += ec_tracer_hit(r, i).prim == EC_NO_ID;
            CHECK_MSG(out == 0, "%s: %u of %u rays leave the bunny", ec_accels[a].name, out, EC_TRACER_RAYS);
        }
    }
    ec_tracer_close(t->tracer);
}

int main(void)
{
    if (access(BUNNY, R_OK)) TEST_SKIP("%s is not there", BUNNY);
    ec_cl cl = {0};
    mesh m;
    ec_soup soup = {0};
    ec_error err = {0};
    int open = kernel_open(&cl);
    if (open) return open;
    CHECK(read_mesh(BUNNY, &m));
    CHECK(close_holes(&m) > 100); /* the mesh has five holes */
    CHECK_OK(ec_soup_make(m.faces, &soup, &err), err);
    for (uint32_t i = 0; i < 3 * soup.count; i++) memcpy(soup.vertices + 3 * (size_t)i, m.at + 3 * (size_t)m.corner[i], 3 * sizeof(float));
    if (!test_failures) trace_all(&(ec_selftest){.cl = &cl, .lanes = 8, .full = true}, &soup);
    ec_soup_free(&soup);
    free(m.at);
    free(m.corner);
    ec_cl_close(&cl);
    TEST_END();
}
