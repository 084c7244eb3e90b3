/* Rays a second beside Embree 3's single rays, turn by turn on the same rays and threads. See README.md. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_device.h"
#include "bench_embree.h"
#include "gltf/reader.h"

#define MOST_RUNS 99
#define MOST_SETS 8

static const char usage[] =
    "usage: bench_traversal [SCENE] [options]\n"
    "  SCENE            a number of bumpy spheres in a room (38400 triangles each; default 27), or a file: .obj, .ply,\n"
    "                   .gltf, .glb\n"
    "  --size N         N x N camera rays (default 1024)\n"
    "  --runs N         alternating runs (default 7)\n"
    "  --threads N      of Embree (default: as many as the device has units)\n"
    "  --robust         Embree's watertight variant instead of its default\n"
    "  --accel A,B,...  acceleration structures to measure (default: bvh8,bvh2), or all but none with `all`\n"
    "  --grid-density X cells a triangle in the grid (default: 27)\n"
    "  --no-packet      leave the packets of bvh2 out (they are slow on large scenes)\n"
    "  --lanes N        of these packets (default: the device's)\n"
    "  --device ID      OpenCL device, as for eclat\n"
    "  --kernels DIR    measure the kernels of another kernels/ folder too, and compare their hits bit by bit; may be repeated\n"
    "  --cpu-time       count processor time instead of wall time: steadier on a shared machine (set OMP_WAIT_POLICY=passive)\n"
    "  --json           one JSON object instead of the table\n";

typedef struct options {
    const char *scene, *device;
    uint32_t size, runs, lanes;
    int threads;
    bool robust, json;
    uint32_t accels[EC_ACCEL_COUNT], accel_count; /* in the order asked for; bits are compared with the first's */
    float grid_density;
    bench_kernels sets[MOST_SETS];
    uint32_t set_count;
} options;

static const char *const kind_names[] = {"camera", "bounce", "shadow"};
static const double targets[] = {1.1, 0.9, 0.95};

static uint32_t mask_of(const options *o)
{
    uint32_t mask = 0;
    for (uint32_t i = 0; i < o->accel_count; i++) mask |= 1u << o->accels[i];
    return mask;
}

static void die(const char *what)
{
    fprintf(stderr, "bench_traversal: %s\n", what);
    exit(1);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(const double *values, uint32_t count)
{
    double sorted[MOST_RUNS];
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, ascending);
    return count % 2 ? sorted[count / 2] : 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]);
}

static void choose_accels(options *o, const char *names)
{
    char text[256];
    o->accel_count = 0;
    snprintf(text, sizeof text, "%s", !strcmp(names, "all") ? "bvh8,bvh2,grid,kdtree" : names);
    for (char *rest, *name = strtok_r(text, ",", &rest); name && o->accel_count < EC_ACCEL_COUNT; name = strtok_r(NULL, ",", &rest)) {
        uint32_t which = ec_accel_find(name);
        if (which == EC_ACCEL_COUNT) die("no such acceleration structure");
        o->accels[o->accel_count++] = which;
    }
}

static options parse(int argc, char **argv)
{
    options o = {.scene = "27", .size = 1024, .runs = 7, .set_count = 1};
    choose_accels(&o, "bvh8,bvh2");
    for (int i = 1; i < argc; i++) {
        const char *a = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (!strcmp(a, "--help")) {
            fputs(usage, stdout);
            exit(0);
        }
        if (!strcmp(a, "--robust")) o.robust = true;
        else if (!strcmp(a, "--no-packet")) choose_accels(&o, "bvh8");
        else if (!strcmp(a, "--json")) o.json = true;
        else if (!strcmp(a, "--cpu-time")) bench_clock_use_cpu_time();
        else if (a[0] != '-') o.scene = a;
        else if (!value) break;
        else if (!strcmp(a, "--size") && ++i) o.size = (uint32_t)atoi(value);
        else if (!strcmp(a, "--runs") && ++i) o.runs = (uint32_t)atoi(value);
        else if (!strcmp(a, "--threads") && ++i) o.threads = atoi(value);
        else if (!strcmp(a, "--lanes") && ++i) o.lanes = (uint32_t)atoi(value);
        else if (!strcmp(a, "--accel") && ++i) choose_accels(&o, value);
        else if (!strcmp(a, "--grid-density") && ++i) o.grid_density = (float)atof(value);
        else if (!strcmp(a, "--device") && ++i) o.device = value;
        else if (!strcmp(a, "--kernels") && o.set_count < MOST_SETS && ++i) o.sets[o.set_count++].folder = value;
        else {
            fprintf(stderr, "bench_traversal: '%s' is not an option\n%s", a, usage);
            exit(2);
        }
    }
    if (o.size < 8 || o.size > 16384 || o.runs < 1 || o.runs > MOST_RUNS) {
        fputs(usage, stderr);
        exit(2);
    }
    return o;
}

static void load_gltf(const char *path, bench_mesh *mesh)
{
    ec_error err;
    ec_scene *scene;
    if (ec_scene_load(path, &scene, NULL, &err)) die(err.text);
    *mesh = (bench_mesh){malloc(12 * (size_t)scene->vertex_count), malloc(12 * (size_t)scene->triangle_count),
                         scene->vertex_count, scene->triangle_count};
    if (!mesh->positions || !mesh->indices) die("out of memory");
    memcpy(mesh->positions, scene->positions, 12 * (size_t)scene->vertex_count);
    memcpy(mesh->indices, scene->indices, 12 * (size_t)scene->triangle_count);
    ec_scene_free(scene);
}

static void load(const char *what, bench_mesh *mesh)
{
    const char *suffix = strrchr(what, '.');
    if (suffix && (!strcmp(suffix, ".gltf") || !strcmp(suffix, ".glb"))) load_gltf(what, mesh);
    else if (!bench_mesh_open(what, mesh)) die("cannot read the mesh");
}

/* Distance of a hit in double, from its barycentrics: the kernels do not write t. */
static double distance(const bench_mesh *mesh, const bench_ray *ray, const bench_found *f)
{
    double up = 0.0, down = 0.0, b[3] = {1.0 - f->b1 - f->b2, f->b1, f->b2};
    for (int k = 0; k < 3; k++) {
        double p = 0.0;
        for (int c = 0; c < 3; c++) p += b[c] * mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)f->prim + c] + k];
        up += (p - ray->o[k]) * ray->d[k];
        down += (double)ray->d[k] * ray->d[k];
    }
    return up / down;
}

static bool differs(const bench_mesh *mesh, const bench_ray *ray, bench_kind kind, const bench_hit *a, const bench_found *b)
{
    if (a->prim == b->prim) return false;
    if (kind == BENCH_SHADOW || a->prim == UINT32_MAX || b->prim == UINT32_MAX) return true;
    return fabs(distance(mesh, ray, b) - a->t) > 1e-4 * fabs(a->t);
}

typedef struct results {
    double embree[BENCH_KIND_COUNT][MOST_RUNS]; /* seconds */
    double ours[MOST_SETS][EC_ACCEL_COUNT][BENCH_KIND_COUNT][MOST_RUNS];
    uint32_t mismatches[MOST_SETS][EC_ACCEL_COUNT][BENCH_KIND_COUNT]; /* against Embree */
    uint32_t other_bits[MOST_SETS][EC_ACCEL_COUNT][BENCH_KIND_COUNT]; /* against the first ones */
    uint32_t found[BENCH_KIND_COUNT];                                    /* rays that met something, by Embree */
} results;

static double embree_run(const bench_embree *e, bench_kind kind, const bench_rays *rays, bench_hit *hits)
{
    return kind == BENCH_SHADOW ? bench_embree_any(e, rays, hits) : bench_embree_closest(e, rays, hits);
}

/* Warm-up, and who found what. */
static void compare(bench_device *d, options *o, const bench_embree *e, const bench_mesh *mesh, bench_kind kind,
                    const bench_rays *rays, results *r)
{
    ec_error err;
    size_t bytes = (rays->count + 1) * sizeof(bench_found);
    bench_hit *hits = malloc((rays->count + 1) * sizeof *hits);
    bench_found *first = malloc(bytes), *found = malloc(bytes);
    if (!hits || !first || !found) die("out of memory");
    embree_run(e, kind, rays, hits);
    for (uint32_t i = 0; i < rays->count; i++) r->found[kind] += hits[i].prim != UINT32_MAX;
    for (uint32_t set = 0; set < o->set_count; set++)
        for (int trace = 0; trace < (int)o->accel_count; trace++) {
            bench_found *to = set == 0 && trace == 0 ? first : found;
            if (bench_device_found(d, &o->sets[set], o->accels[trace], kind, to, &err)) die(err.text);
            uint32_t *mismatches = &r->mismatches[set][trace][kind], *other = &r->other_bits[set][trace][kind];
            for (uint32_t i = 0; i < rays->count; i++) {
                *mismatches += differs(mesh, &rays->rays[i], kind, &hits[i], &to[i]);
                bool missed = to[i].prim == UINT32_MAX && first[i].prim == UINT32_MAX; /* b1 and b2 mean nothing */
                *other += !missed && memcmp(&to[i], &first[i], sizeof *to) != 0;
            }
        }
    free(hits);
    free(first);
    free(found);
}

static void measure(bench_device *d, options *o, const bench_embree *e, bench_kind kind, const bench_rays *rays, results *r)
{
    ec_error err;
    bench_hit *hits = malloc((rays->count + 1) * sizeof *hits);
    if (!hits) die("out of memory");
    /* Each is timed the second time in a row: whoever comes after another finds the caches full of the other's data. */
    for (uint32_t run = 0; run < o->runs; run++) {
        embree_run(e, kind, rays, hits);
        r->embree[kind][run] = embree_run(e, kind, rays, hits);
        for (int trace = 0; trace < (int)o->accel_count; trace++)
            for (uint32_t s = 0; s < o->set_count; s++) {
                uint32_t set = (s + run) % o->set_count;
                for (int pass = 0; pass < 2; pass++)
                    if (bench_device_trace(d, &o->sets[set], o->accels[trace], kind, &r->ours[set][trace][kind][run], &err)) die(err.text);
            }
    }
    free(hits);
}

static double ratio(const options *o, const double *embree, const double *ours)
{
    double ratios[MOST_RUNS];
    for (uint32_t run = 0; run < o->runs; run++) ratios[run] = embree[run] / ours[run];
    return median(ratios, o->runs);
}

static const char *set_name(const options *o, uint32_t set) { return o->sets[set].folder ? o->sets[set].folder : "embedded"; }

static void print_table(const options *o, const bench_device *d, const bench_mesh *mesh, const results *r)
{
    printf("%s: %u triangles; median of %u alternating runs; %d Embree threads%s; %s, packets of %u\n", o->scene,
           mesh->triangle_count, o->runs, o->threads, o->robust ? ", robust" : "", d->cl.info.name, d->lanes);
    printf("%-8s %-8s %10s %8s %8s %5s %11s %10s  %s\n", "rays", "tracer", "Mrays/s", "ratio", "target", "met", "mismatches",
           "other bits", "kernels");
    for (int kind = 0; kind < BENCH_KIND_COUNT; kind++) {
        printf("%-8s %-8s %10.2f %8s %8s %5s %11s %10s  %u rays, %.1f %% find something\n", kind_names[kind], "embree",
               d->counts[kind] / median(r->embree[kind], o->runs) * 1e-6, "1", "", "", "", "", d->counts[kind],
               100.0 * r->found[kind] / d->counts[kind]);
        for (int trace = 0; trace < (int)o->accel_count; trace++)
            for (uint32_t set = 0; set < o->set_count; set++) {
                double x = ratio(o, r->embree[kind], r->ours[set][trace][kind]);
                printf("%-8s %-8s %10.2f %8.3f %8.2f %5s %11u %10u  %s\n", kind_names[kind], ec_accels[o->accels[trace]].name,
                       d->counts[kind] / median(r->ours[set][trace][kind], o->runs) * 1e-6, x, targets[kind],
                       x >= targets[kind] ? "yes" : "no", r->mismatches[set][trace][kind], r->other_bits[set][trace][kind],
                       set_name(o, set));
            }
    }
}

static void print_builds(const options *o, const bench_device *d)
{
    printf("%-8s %10s %10s %12s %12s %12s %10s\n", "accel", "build s", "MB", "nodes", "leaves", "references", "SAH cost");
    for (uint32_t i = 0; i < o->accel_count; i++) {
        const ec_accel_stats *s = &d->accel_stats[o->accels[i]];
        printf("%-8s %10.3f %10.1f %12llu %12llu %12llu %10.2f\n", ec_accels[o->accels[i]].name, s->build_seconds, (double)s->bytes * 1e-6,
               (unsigned long long)s->nodes, (unsigned long long)s->leaves, (unsigned long long)s->references, s->sah_cost);
    }
}

static void print_json(const options *o, const bench_device *d, const bench_mesh *mesh, const results *r)
{
    printf("{\"scene\": \"%s\", \"triangles\": %u, \"runs\": %u, \"threads\": %d, \"robust\": %s, \"device\": \"%s\", "
           "\"lanes\": %u, \"results\": [",
           o->scene, mesh->triangle_count, o->runs, o->threads, o->robust ? "true" : "false", d->cl.info.name, d->lanes);
    const char *comma = "";
    for (int kind = 0; kind < BENCH_KIND_COUNT; kind++)
        for (int trace = 0; trace < (int)o->accel_count; trace++)
            for (uint32_t set = 0; set < o->set_count; set++) {
                printf("%s\n  {\"rays\": \"%s\", \"count\": %u, \"kernel\": \"%s\", \"kernels\": \"%s\", "
                       "\"embree_mrays_per_second\": %.4f, \"mrays_per_second\": %.4f, \"ratio\": %.4f, \"target\": %.2f, "
                       "\"mismatches\": %u, \"other_bits\": %u}",
                       comma, kind_names[kind], d->counts[kind], ec_accels[o->accels[trace]].name, set_name(o, set),
                       d->counts[kind] / median(r->embree[kind], o->runs) * 1e-6,
                       d->counts[kind] / median(r->ours[set][trace][kind], o->runs) * 1e-6,
                       ratio(o, r->embree[kind], r->ours[set][trace][kind]), targets[kind],
                       r->mismatches[set][trace][kind], r->other_bits[set][trace][kind]);
                comma = ",";
            }
    printf("\n]}\n");
}

int main(int argc, char **argv)
{
    options o = parse(argc, argv);
    static results r;
    ec_error err;
    bench_mesh mesh;
    load(o.scene, &mesh);
    float scene_max = bench_recentre(&mesh);
    bench_rays rays[BENCH_KIND_COUNT];
    rays[BENCH_CAMERA] = bench_camera_rays(&mesh, o.size);
    if (!rays[BENCH_CAMERA].rays) die("out of memory");

    bench_device d;
    if (bench_device_open(&d, o.device, o.lanes, &mesh, scene_max, rays[BENCH_CAMERA].count, mask_of(&o), o.grid_density, &err)) die(err.text);
    if (!o.threads) o.threads = d.cl.info.type & CL_DEVICE_TYPE_CPU ? (int)d.cl.info.compute_units : omp_get_max_threads();
    bench_embree *e = bench_embree_create(&mesh, o.threads, o.robust);
    bench_hit *hits = malloc(rays[BENCH_CAMERA].count * sizeof *hits);
    if (!e || !hits) die("Embree cannot build this scene");
    bench_embree_closest(e, &rays[BENCH_CAMERA], hits);
    rays[BENCH_BOUNCE] = bench_bounce_rays(&mesh, &rays[BENCH_CAMERA], hits);
    rays[BENCH_SHADOW] = bench_shadow_rays(&mesh, &rays[BENCH_BOUNCE]);
    free(hits);
    if (!rays[BENCH_BOUNCE].count || !rays[BENCH_SHADOW].rays) die("no camera ray hits anything");

    for (uint32_t set = 0; set < o.set_count; set++)
        if (bench_device_kernels(&d, &o.sets[set], mask_of(&o), &err)) die(err.text);
    for (int kind = 0; kind < BENCH_KIND_COUNT; kind++) {
        if (bench_device_rays(&d, kind, &rays[kind], &err)) die(err.text);
        compare(&d, &o, e, &mesh, kind, &rays[kind], &r);
        measure(&d, &o, e, kind, &rays[kind], &r);
    }
    if (o.json) print_json(&o, &d, &mesh, &r);
    else {
        print_table(&o, &d, &mesh, &r);
        print_builds(&o, &d);
    }

    for (uint32_t set = 0; set < o.set_count; set++) bench_device_release(&o.sets[set]);
    for (int kind = 0; kind < BENCH_KIND_COUNT; kind++) free(rays[kind].rays);
    bench_device_close(&d);
    bench_embree_destroy(e);
    bench_mesh_free(&mesh);
    return 0;
}
