
#include "base/text.h"
#include "report/effects_report.h"
#include "report/format.h"
#include "report/scene_report.h"

#define DEGREES(radians) ((radians) * 57.29577951308232)

void ec_camera_describe(const ec_scene *scene, uint32_t index, char *text, size_t size)
{
    const ec_camera *camera = &scene->cameras[index];
    int used = snprintf(text, size, "%u ", index);
    if (camera->name) used += snprintf(text + used, size - (size_t)used, "'%.*s' ", EC_CUT(camera->name, 100));
    if (camera->type == EC_CAMERA_PERSPECTIVE)
        snprintf(text + used, size - (size_t)used, "(perspective, %.3g degrees high)", DEGREES(camera->yfov));
    else
        snprintf(text + used, size - (size_t)used, "(orthographic, %.3g x %.3g)", 2 * camera->xmag, 2 * camera->ymag);
}

static void print_geometry(const ec_scene *scene, FILE *to)
{
    fprintf(to, "geometry    %u meshes in %u instances, %u nodes\n", scene->mesh_count, scene->instance_count,
            scene->node_count);
    fprintf(to, "triangles   %u, with %u vertices\n", scene->triangle_count, scene->vertex_count);
    if (scene->placed_count)
        fprintf(to, "kept once   %u meshes at %u places: %llu triangles in all\n", scene->shape_count, scene->placed_count,
                (unsigned long long)ec_scene_met_count(scene));
    if (scene->dropped_degenerate || scene->dropped_nonfinite)
        fprintf(to, "dropped     %u degenerate and %u non-finite triangles\n", scene->dropped_degenerate,
                scene->dropped_nonfinite);
    if (scene->skipped_primitives) fprintf(to, "skipped     %u primitives without positions\n", scene->skipped_primitives);
    if (scene->triangle_count)
        fprintf(to, "extent      %.4g x %.4g x %.4g\n", (double)scene->bounds_max[0] - scene->bounds_min[0],
                (double)scene->bounds_max[1] - scene->bounds_min[1], (double)scene->bounds_max[2] - scene->bounds_min[2]);
    fprintf(to, "materials   %u, with %u textures from %u images\n", scene->material_count, scene->texture_count,
            scene->image_count);
}

static void print_lights(const ec_scene_report *report, FILE *to)
{
    fprintf(to, "lights      %u emissive triangles, %u point, %u spot, %u directional, %s\n", report->emissive_triangles,
            report->light_types[EC_LIGHT_POINT], report->light_types[EC_LIGHT_SPOT],
            report->light_types[EC_LIGHT_DIRECTIONAL],
            report->scene->has_environment ? "an environment" : "no environment");
    if (report->takes_studio) fputs("            none at all: a render uses the built-in studio\n", to);
}

static void print_cameras(const ec_scene *scene, FILE *to)
{
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        char text[256];
        ec_camera_describe(scene, i, text, sizeof text);
        fprintf(to, "%s%s%s\n", i == 0 ? "cameras     " : "            ", text,
                scene->camera_count > 1 && i == scene->default_camera ? ", the default" : "");
    }
}

static void print_list(const char *title, const ec_scene_names *list, FILE *to)
{
    fprintf(to, "%s", title);
    if (list->count == 0) fputs("none", to);
    for (uint32_t i = 0; i < list->count; i++) fprintf(to, "%s%s", i ? ", " : "", list->names[i]);
    fputc('\n', to);
}

/* Prints e.g. "0 'walk' (1.2 s), 1 'run'". */
static void print_names(const char *title, const ec_scene_names *list, const double *seconds, FILE *to)
{
    if (list->count) fprintf(to, "%s", title);
    for (uint32_t i = 0; i < list->count; i++) {
        fprintf(to, "%s%u", i ? ", " : "", i);
        if (list->names[i]) fprintf(to, " '%.*s'", EC_CUT(list->names[i], 100));
        if (seconds && seconds[i] >= 0) fprintf(to, " (%.4g s)", seconds[i]);
    }
    if (list->count) fputc('\n', to);
}

/* Prints the scenes, variants and animations that can be chosen. */
static void print_contents(const ec_scene_contents *contents, FILE *to)
{
    if (contents->scenes.count > 1) {
        print_names("scenes      ", &contents->scenes, NULL, to);
        fprintf(to, "            %u is shown\n", contents->scene);
    }
    print_names("variants    ", &contents->variants, NULL, to);
    print_names("animations  ", &contents->animations, contents->seconds, to);
}

static void print_cost(const ec_scene_report *report, FILE *to)
{
    const ec_bvh_stats *bvh = &report->bvh;
    ec_effects_text(&report->effects, to, 12);
    fprintf(to, "memory      %s on the device for the scene, without the film; %s on the host at peak\n", ec_bytes(report->device_bytes).text,
            ec_bytes(report->peak_memory_bytes).text);
    fprintf(to, "BVH         %u nodes, %u leaves, depth %u, SAH cost %.4g, leaf blocks %.0f %% full\n", bvh->node_count,
            bvh->leaf_count, bvh->max_depth, bvh->sah_cost, 100 * bvh->leaf_fill);
    uint32_t triangles = ec_scene_flat_count(report->scene); /* meshes that are kept once have BVHs of their own */
    if (bvh->ref_count > triangles)
        fprintf(to, "            %u references: triangles cut into %.1f %% more parts\n", bvh->ref_count,
                100.0 * (bvh->ref_count - triangles) / triangles);
    fprintf(to, "time        %s to load, %s to build the BVH\n", ec_seconds(report->load_seconds).text, ec_seconds(bvh->build_seconds).text);
}

static void print_accel(const ec_accel_report *a, FILE *to)
{
    const ec_accel_stats *b = &a->probe.build;
    char cost[32] = "-";
    if (*a->refused) {
        fprintf(to, "%-8s %s\n", a->name, a->refused);
        return;
    }
    if (b->sah_cost > 0) snprintf(cost, sizeof cost, "%.4g", b->sah_cost);
    fprintf(to, "%-8s %9s %10s %8s %8s %10s %8s %10.1f %14.1f %9s\n", a->name, ec_seconds(b->build_seconds).text, ec_bytes(b->bytes).text,
            ec_count((double)b->nodes).text, ec_count((double)b->leaves).text, ec_count((double)b->references).text, cost,
            a->probe.nodes, a->probe.triangles, ec_count(a->probe.rays_per_second).text);
}

static void print_accels(const ec_scene_report *report, FILE *to)
{
    if (!report->accel_count) return;
    fprintf(to, "\n%u rays from the surfaces in all directions, on %s\n", EC_PROBE_RAYS, report->device);
    fprintf(to, "%-8s %9s %10s %8s %8s %10s %8s %10s %14s %9s\n", "accel", "build", "memory", "nodes", "leaves", "references",
            "SAH cost", "nodes/ray", "triangles/ray", "rays/s");
    for (uint32_t i = 0; i < report->accel_count; i++) print_accel(&report->accels[i], to);
}

void ec_scene_report_text(const ec_scene_report *report, FILE *to)
{
    const ec_scene *scene = report->scene;
    ec_text_print(to, "scene       ", report->path, "\n");
    print_geometry(scene, to);
    print_lights(report, to);
    print_cameras(scene, to);
    print_contents(&scene->contents, to);
    print_list("extensions  ", &scene->contents.extensions, to);
    print_list("unsupported ", &scene->contents.ignored, to);
    ec_caustics_text(report, to);
    print_cost(report, to);
    print_accels(report, to);
}
