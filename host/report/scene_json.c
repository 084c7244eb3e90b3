#include <math.h>

#include "report/effects_report.h"
#include "report/scene_report.h"

static void add_geometry(cJSON *root, const ec_scene *scene)
{
    ec_json_whole(root, "meshes", scene->mesh_count);
    ec_json_whole(root, "instances", scene->instance_count);
    ec_json_whole(root, "nodes", scene->node_count);
    ec_json_whole(root, "triangles", ec_scene_met_count(scene));
    ec_json_whole(root, "stored_triangles", scene->triangle_count);
    ec_json_whole(root, "kept_meshes", scene->shape_count);
    ec_json_whole(root, "kept_instances", scene->placed_count);
    ec_json_whole(root, "vertices", scene->vertex_count);
    ec_json_whole(root, "dropped_degenerate", scene->dropped_degenerate);
    ec_json_whole(root, "dropped_nonfinite", scene->dropped_nonfinite);
    ec_json_whole(root, "skipped_primitives", scene->skipped_primitives);
    ec_json_whole(root, "materials", scene->material_count);
    ec_json_whole(root, "textures", scene->texture_count);
    ec_json_whole(root, "images", scene->image_count);
}

static void add_lights(cJSON *root, const ec_scene_report *report)
{
    cJSON *lights = cJSON_AddObjectToObject(root, "lights");
    ec_json_whole(lights, "emissive_triangles", report->emissive_triangles);
    ec_json_whole(lights, "point", report->light_types[EC_LIGHT_POINT]);
    ec_json_whole(lights, "spot", report->light_types[EC_LIGHT_SPOT]);
    ec_json_whole(lights, "directional", report->light_types[EC_LIGHT_DIRECTIONAL]);
    cJSON_AddBoolToObject(lights, "environment", report->scene->has_environment);
    cJSON_AddBoolToObject(lights, "any", report->has_light);
}

/* Camera to world as a node's matrix has it, by columns: right, up, back, position. */
static cJSON *camera_matrix(const ec_scene *scene, const ec_camera *camera)
{
    double m[16] = {[15] = 1};
    for (int k = 0; k < 3; k++) {
        m[k] = camera->right[k];
        m[4 + k] = camera->up[k];
        m[8 + k] = 0.0 - camera->forward[k];
        m[12 + k] = camera->position[k] + scene->center[k];
    }
    return cJSON_CreateDoubleArray(m, 16);
}

static void add_cameras(cJSON *root, const ec_scene *scene)
{
    cJSON *cameras = cJSON_AddArrayToObject(root, "cameras");
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        const ec_camera *camera = &scene->cameras[i];
        cJSON *object = cJSON_CreateObject();
        bool perspective = camera->type == EC_CAMERA_PERSPECTIVE;
        ec_json_whole(object, "index", i);
        ec_json_text(object, "name", camera->name);
        ec_json_text(object, "type", perspective ? "perspective" : "orthographic");
        if (perspective) ec_json_real(object, "yfov", camera->yfov);
        else {
            ec_json_real(object, "xmag", camera->xmag);
            ec_json_real(object, "ymag", camera->ymag);
        }
        ec_json_real(object, "aspect", camera->aspect > 0 ? camera->aspect : INFINITY); /* null: the image's */
        cJSON_AddItemToObject(object, "matrix", camera_matrix(scene, camera));
        cJSON_AddItemToArray(cameras, object);
    }
    ec_json_whole(root, "default_camera", scene->default_camera);
}

static void add_names(cJSON *root, const char *key, const ec_scene_names *list)
{
    ec_json_texts(root, key, (const char *const *)list->names, list->count);
}

static void add_contents(cJSON *root, const ec_scene_contents *contents)
{
    add_names(root, "scenes", &contents->scenes);
    ec_json_whole(root, "scene_shown", contents->scene);
    add_names(root, "variants", &contents->variants);
    cJSON *animations = cJSON_AddArrayToObject(root, "animations");
    for (uint32_t i = 0; i < contents->animations.count; i++) {
        cJSON *object = cJSON_CreateObject();
        ec_json_text(object, "name", contents->animations.names[i]);
        ec_json_real(object, "seconds", contents->seconds[i]); /* null: the file does not say */
        cJSON_AddItemToArray(animations, object);
    }
}

static void add_bvh(cJSON *root, const ec_bvh_stats *stats)
{
    cJSON *bvh = cJSON_AddObjectToObject(root, "bvh");
    ec_json_whole(bvh, "references", stats->ref_count);
    ec_json_whole(bvh, "nodes", stats->node_count);
    ec_json_whole(bvh, "leaves", stats->leaf_count);
    ec_json_whole(bvh, "max_depth", stats->max_depth);
    ec_json_real(bvh, "sah_cost", stats->sah_cost);
    ec_json_real(bvh, "leaf_fill", stats->leaf_fill);
    ec_json_real(bvh, "build_seconds", stats->build_seconds);
}

static void add_accels(cJSON *root, const ec_scene_report *report)
{
    if (!report->accel_count) return;
    ec_json_text(root, "accel_device", report->device);
    cJSON *array = cJSON_AddArrayToObject(root, "accels");
    for (uint32_t i = 0; i < report->accel_count; i++) {
        const ec_accel_report *a = &report->accels[i];
        const ec_accel_stats *b = &a->probe.build;
        cJSON *object = cJSON_CreateObject();
        cJSON_AddItemToArray(array, object);
        ec_json_text(object, "name", a->name);
        if (*a->refused) {
            ec_json_text(object, "refused", a->refused);
            continue;
        }
        ec_json_real(object, "build_seconds", b->build_seconds);
        ec_json_whole(object, "bytes", b->bytes);
        ec_json_whole(object, "nodes", b->nodes);
        ec_json_whole(object, "leaves", b->leaves);
        ec_json_whole(object, "references", b->references);
        ec_json_real(object, "sah_cost", b->sah_cost > 0 ? b->sah_cost : INFINITY); /* null: means nothing */
        ec_json_real(object, "nodes_per_ray", a->probe.nodes);
        ec_json_real(object, "triangles_per_ray", a->probe.triangles);
        ec_json_real(object, "rays_per_second", a->probe.rays_per_second);
    }
}

ec_result ec_scene_report_json(const ec_scene_report *report, FILE *to, ec_error *err)
{
    const ec_scene *scene = report->scene;
    cJSON *root = cJSON_CreateObject();
    ec_json_text(root, "version", ECLAT_VERSION);
    ec_json_text(root, "scene", report->path);
    add_geometry(root, scene);
    add_lights(root, report);
    add_cameras(root, scene);
    add_contents(root, &scene->contents);
    add_names(root, "extensions_used", &scene->contents.extensions);
    add_names(root, "extensions_unsupported", &scene->contents.ignored);
    ec_effects_json(root, &report->effects);
    add_bvh(root, &report->bvh);
    add_accels(root, report);
    ec_json_real(root, "load_seconds", report->load_seconds);
    ec_json_whole(root, "device_bytes", report->device_bytes);
    ec_json_whole(root, "peak_memory_bytes", report->peak_memory_bytes);
    return ec_json_print(root, to, err);
}
