#include <math.h>

#include "report/effects_report.h"
#include "report/scene_report.h"

static void add_geometry(cJSON *root, const ec_scene *scene)
{
    EC_JSON(root, EC_WHOLE("meshes", scene->mesh_count), EC_WHOLE("instances", scene->instance_count), EC_WHOLE("nodes", scene->node_count),
            EC_WHOLE("triangles", ec_scene_met_count(scene)), EC_WHOLE("stored_triangles", scene->triangle_count),
            EC_WHOLE("kept_meshes", scene->shape_count), EC_WHOLE("kept_instances", scene->placed_count), EC_WHOLE("vertices", scene->vertex_count),
            EC_WHOLE("dropped_degenerate", scene->dropped_degenerate), EC_WHOLE("dropped_nonfinite", scene->dropped_nonfinite),
            EC_WHOLE("skipped_primitives", scene->skipped_primitives), EC_WHOLE("materials", scene->material_count),
            EC_WHOLE("textures", scene->texture_count), EC_WHOLE("images", scene->image_count));
}

static void add_lights(cJSON *root, const ec_scene_report *report)
{
    EC_JSON(ec_json_object(root, "lights"), EC_WHOLE("emissive_triangles", report->emissive_triangles),
            EC_WHOLE("point", report->light_types[EC_LIGHT_POINT]), EC_WHOLE("spot", report->light_types[EC_LIGHT_SPOT]),
            EC_WHOLE("directional", report->light_types[EC_LIGHT_DIRECTIONAL]), EC_FLAG("environment", report->scene->has_environment),
            EC_FLAG("any", report->has_light));
}

/* Returns the camera-to-world matrix in the form of a node's, by columns: right, up, back, position. */
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
        cJSON *object = ec_json_object(cameras, NULL);
        bool perspective = camera->type == EC_CAMERA_PERSPECTIVE;
        EC_JSON(object, EC_WHOLE("index", i), EC_STRING("name", camera->name), EC_STRING("type", perspective ? "perspective" : "orthographic"));
        if (perspective) ec_json_real(object, "yfov", camera->yfov);
        else EC_JSON(object, EC_REAL("xmag", camera->xmag), EC_REAL("ymag", camera->ymag));
        ec_json_real(object, "aspect", camera->aspect > 0 ? camera->aspect : INFINITY); /* null: the image's */
        cJSON_AddItemToObject(object, "matrix", camera_matrix(scene, camera));
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
    for (uint32_t i = 0; i < contents->animations.count; i++) /* seconds null: the file does not tell */
        EC_JSON(ec_json_object(animations, NULL), EC_STRING("name", contents->animations.names[i]), EC_REAL("seconds", contents->seconds[i]));
}

static void add_bvh(cJSON *root, const ec_bvh_stats *stats)
{
    EC_JSON(ec_json_object(root, "bvh"), EC_WHOLE("references", stats->ref_count), EC_WHOLE("nodes", stats->node_count),
            EC_WHOLE("leaves", stats->leaf_count), EC_WHOLE("max_depth", stats->max_depth), EC_REAL("sah_cost", stats->sah_cost),
            EC_REAL("leaf_fill", stats->leaf_fill), EC_REAL("build_seconds", stats->build_seconds));
}

static void add_accels(cJSON *root, const ec_scene_report *report)
{
    if (!report->accel_count) return;
    ec_json_text(root, "accel_device", report->device);
    cJSON *array = cJSON_AddArrayToObject(root, "accels");
    for (uint32_t i = 0; i < report->accel_count; i++) {
        const ec_accel_report *a = &report->accels[i];
        const ec_accel_stats *b = &a->probe.build;
        cJSON *object = ec_json_object(array, NULL);
        ec_json_text(object, "name", a->name);
        if (*a->refused) ec_json_text(object, "refused", a->refused);
        else
            EC_JSON(object, EC_REAL("build_seconds", b->build_seconds), EC_WHOLE("bytes", b->bytes), EC_WHOLE("nodes", b->nodes),
                    EC_WHOLE("leaves", b->leaves), EC_WHOLE("references", b->references),
                    EC_REAL("sah_cost", b->sah_cost > 0 ? b->sah_cost : INFINITY), /* null: not meaningful */
                    EC_REAL("nodes_per_ray", a->probe.nodes), EC_REAL("triangles_per_ray", a->probe.triangles),
                    EC_REAL("rays_per_second", a->probe.rays_per_second));
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
    ec_caustics_json(report, root);
    ec_effects_json(root, &report->effects);
    add_bvh(root, &report->bvh);
    add_accels(root, report);
    ec_json_real(root, "load_seconds", report->load_seconds);
    ec_json_whole(root, "device_bytes", report->device_bytes);
    ec_json_whole(root, "peak_memory_bytes", report->peak_memory_bytes);
    return ec_json_print(root, to, err);
}
