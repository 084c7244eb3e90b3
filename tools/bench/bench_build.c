/* Build times beside Embree 3 (rtcCommitScene, medium quality), turn by turn on the same triangles and all cores.
 *
 *   bench_build                    a room of bumpy spheres, 1.04 million triangles
 *   bench_build SPHERES            the same with another number of spheres (38400 triangles each)
 *   bench_build MESH.obj|MESH.ply  a mesh (PLY: binary little-endian, float vertices first, then triangles)
 *
 * By hand: gcc -std=c11 -O3 -fopenmp -ffp-contract=off -D_DEFAULT_SOURCE -Ihost -Ikernels tools/bench/bench_build*.c \
 *              host/accel/[a-z]*.c host/base/error.c host/base/clock.c -lembree3 -lm -o /tmp/bench_build
 */
#include <embree3/rtcore.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "accel/bvh.h"
#include "base/clock.h"
#include "bench_build_mesh.h"

#define RUNS 5

static void die(const char *what)
{
    fprintf(stderr, "bench_build: %s\n", what);
    exit(1);
}

/* Idle workers of either library spin for a while, on the core that the other one needs. */
static void let_workers_sleep(void) { nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL); }

static double build_embree(RTCDevice device, const bench_mesh *mesh)
{
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                               mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                                mesh->triangle_count);
    if (!positions || !indices) die("out of memory");
    memcpy(positions, mesh->positions, 12 * (size_t)mesh->vertex_count);
    memcpy(indices, mesh->indices, 12 * (size_t)mesh->triangle_count);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    double start = ec_now();
    rtcCommitScene(scene);
    double seconds = ec_now() - start;
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
    return seconds;
}

typedef struct times {
    double tree[RUNS], wide[RUNS], binary[RUNS], embree[RUNS];
    ec_bvh_stats stats;
    uint32_t wide_nodes, blocks, binary_nodes;
} times;

static void build_ours(const bench_mesh *mesh, times *t, int run)
{
    ec_error err;
    ec_bvh bvh;
    ec_bvh8 wide;
    ec_bvh2 binary;
    double start = ec_now();
    if (ec_bvh_build(mesh->positions, mesh->indices, mesh->triangle_count, 0, &bvh, &t->stats, &err)) die(err.text);
    t->tree[run] = t->stats.build_seconds;
    start = ec_now();
    if (ec_bvh8_layout(&bvh, mesh->positions, mesh->indices, &wide, &err)) die(err.text);
    t->wide[run] = ec_now() - start;
    t->wide_nodes = wide.node_count;
    t->blocks = wide.block_count;
    free(wide.nodes);
    free(wide.blocks);
    free(wide.boxes);
    start = ec_now();
    if (ec_bvh2_layout(&bvh, mesh->positions, mesh->indices, &binary, &err)) die(err.text);
    t->binary[run] = ec_now() - start;
    t->binary_nodes = binary.node_count;
    free(binary.nodes);
    free(binary.triangles);
    free(binary.boxes);
    ec_bvh_free(&bvh);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values)
{
    qsort(values, RUNS, sizeof *values, ascending);
    return values[RUNS / 2];
}

int main(int argc, char **argv)
{
    bench_mesh mesh;
    if (!bench_mesh_open(argc > 1 ? argv[1] : "27", &mesh)) die("cannot read the mesh");
    times t;
    RTCDevice device = rtcNewDevice(NULL);
    if (!device) die("no Embree device");
    for (int run = 0; run < RUNS; run++) {
        let_workers_sleep();
        t.embree[run] = build_embree(device, &mesh);
        let_workers_sleep();
        build_ours(&mesh, &t, run);
    }
    rtcReleaseDevice(device);
    double tree = median(t.tree), wide = median(t.wide), binary = median(t.binary), embree = median(t.embree);
    printf("triangles %u  threads %d  median of %d\n", mesh.triangle_count, omp_get_max_threads(), RUNS);
    printf("embree commit    %7.1f ms\n", 1e3 * embree);
    printf("tree             %7.1f ms  %.2f x embree\n", 1e3 * tree, tree / embree);
    printf("tree + 8-wide    %7.1f ms  %.2f x embree\n", 1e3 * (tree + wide), (tree + wide) / embree);
    printf("tree + binary    %7.1f ms  %.2f x embree\n", 1e3 * (tree + binary), (tree + binary) / embree);
    printf("tree: references %u nodes %u leaves %u depth %u fill %.3f sah %.2f; 8-wide: nodes %u blocks %u fill %.3f; binary: nodes %u\n",
           t.stats.ref_count, t.stats.node_count, t.stats.leaf_count, t.stats.max_depth, t.stats.leaf_fill, t.stats.sah_cost,
           t.wide_nodes, t.blocks, t.stats.ref_count / (8.0 * t.blocks), t.binary_nodes);
    bench_mesh_free(&mesh);
    return 0;
}
