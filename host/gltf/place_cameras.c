/* Places the file's cameras at their nodes, or makes one that frames the whole scene. */
#include "gltf/flatten.h"

#include <math.h>

#include "base/freed.h"
#include "base/vec3.h"

/* Sets the orthonormal frame closest to looking along `forward` with `up` up; a node's scale, shear and mirroring do not apply to a camera. */
static void set_frame(ec_camera *camera, double forward[3], double up[3])
{
    double right[3];
    if (!ec_normalize(up)) memcpy(up, (double[3]){0, 1, 0}, 3 * sizeof *up);
    if (!ec_normalize(forward)) memcpy(forward, (double[3]){0, 0, -1}, 3 * sizeof *forward);
    ec_cross(forward, up, right);
    if (!ec_normalize(right)) {
        int axis = fabs(forward[1]) < 0.9 ? 1 : 2;
        double other[3] = {0, axis == 1, axis == 2};
        ec_cross(forward, other, right);
        ec_normalize(right);
    }
    ec_cross(right, forward, up);
    for (int i = 0; i < 3; i++) {
        camera->right[i] = (float)right[i];
        camera->up[i] = (float)up[i];
        camera->forward[i] = (float)forward[i];
    }
}

static const double radians = 3.14159265358979323846 / 180;

ec_result ec_camera_look(const ec_viewpoint *v, const double center[3], ec_camera *camera, ec_error *err)
{
    double forward[3], up[3];
    *camera = (ec_camera){.type = v->fov > 0 ? EC_CAMERA_PERSPECTIVE : EC_CAMERA_ORTHOGRAPHIC,
                          .yfov = (float)(v->fov * radians), .ymag = (float)(0.5 * v->tall)};
    bool finite = isfinite(camera->yfov) && isfinite(camera->ymag);
    for (int i = 0; i < 3; i++) {
        forward[i] = v->target[i] - v->eye[i];
        up[i] = v->up[i];
        camera->position[i] = (float)(v->eye[i] - center[i]);
        finite = finite && isfinite(camera->position[i]) && isfinite(up[i]);
    }
    if (!finite || !ec_normalize(forward))
        return ec_fail(err, "a camera at %g,%g,%g cannot look at %g,%g,%g: give two different points", v->eye[0],
                       v->eye[1], v->eye[2], v->target[0], v->target[1], v->target[2]);
    set_frame(camera, forward, up);
    return EC_OK;
}

double ec_camera_reach(const ec_scene *s, const ec_camera *camera)
{
    double along = 0;
    for (int i = 0; i < 3; i++)
        along += (0.5 * ((double)s->bounds_min[i] + s->bounds_max[i]) - camera->position[i]) * camera->forward[i];
    return along > 0 ? along : 1;
}

void ec_camera_viewpoint(const ec_camera *c, const double center[3], double distance, ec_viewpoint *v)
{
    *v = (ec_viewpoint){.fov = c->type == EC_CAMERA_PERSPECTIVE ? c->yfov / radians : 0, .tall = 2 * (double)c->ymag};
    for (int i = 0; i < 3; i++) {
        v->eye[i] = c->position[i] + center[i];
        v->target[i] = v->eye[i] + distance * c->forward[i];
        v->up[i] = c->up[i];
    }
}

static bool place_camera(const ec_placement *at, const double center[3], ec_camera *camera)
{
    double forward[3], up[3];
    bool finite = true;
    for (int i = 0; i < 3; i++) {
        forward[i] = -at->linear[3 * i + 2];
        up[i] = at->linear[3 * i + 1];
        camera->position[i] = (float)(at->origin[i] - center[i]);
        finite = finite && isfinite(camera->position[i]);
    }
    set_frame(camera, forward, up);
    return finite;
}

enum { WAYS = 8 };

/* Adds up, for each way, the area of front faces (and of both sides of double-sided ones) as an orthographic camera along it would see it without
 * occlusion. */
static void add_front_areas(const ec_scene *s, double ways[WAYS][3], double areas[WAYS])
{
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *v = s->indices + 3 * (size_t)t;
        const bool double_sided = s->materials[s->triangle_material[t]].double_sided;
        double normal[3];
        ec_triangle_normal(s->positions + 3 * (size_t)v[0], s->positions + 3 * (size_t)v[1], s->positions + 3 * (size_t)v[2], normal);
        for (int k = 0; k < WAYS; k++) {
            const double turned = -ec_dot(normal, ways[k]);
            areas[k] += double_sided ? fabs(turned) : fmax(turned, 0);
        }
    }
}

/* Chooses the view from the upper right of the front, unless more than twice the area faces one of the seven other corners; closed surfaces show the
 * same area to all. */
static void choose_way(const ec_scene *s, double forward[3])
{
    static const double first[3] = {-0.5, -0.35, -1};
    double ways[WAYS][3], areas[WAYS] = {0};
    int best = 0;
    for (int corner = 0; corner < WAYS; corner++) {
        for (int k = 0; k < 3; k++) ways[corner][k] = corner >> (k == 2 ? 0 : k + 1) & 1 ? -first[k] : first[k]; /* corner 1 is the back */
        ec_normalize(ways[corner]);
    }
    add_front_areas(s, ways, areas);
    for (int corner = 1; corner < WAYS; corner++)
        if (areas[corner] > 2 * areas[best]) best = corner;
    memcpy(forward, ways[best], sizeof ways[best]);
}

/* Returns a camera with a vertical field of view of 45 degrees, as near as the bounding sphere allows. */
static ec_camera framing_camera(const ec_scene *s)
{
    ec_camera camera = {.type = EC_CAMERA_PERSPECTIVE, .yfov = 0.7853982f};
    double radius = 0;
    for (int i = 0; i < 3; i++) {
        double half = 0.5 * ((double)s->bounds_max[i] - s->bounds_min[i]);
        radius += half * half;
    }
    radius = sqrt(radius);
    double forward[3], up[3] = {0, 1, 0};
    choose_way(s, forward);
    set_frame(&camera, forward, up);
    double distance = radius / sin(0.5 * camera.yfov);
    for (int i = 0; i < 3; i++) {
        double middle = 0.5 * ((double)s->bounds_max[i] + s->bounds_min[i]);
        camera.position[i] = (float)(middle - distance * forward[i]);
    }
    return camera;
}

static char *camera_name(const ec_gltf *g, int32_t node)
{
    const char *own = g->cameras[g->nodes[node].camera].name, *name = own ? own : g->nodes[node].name;
    return name ? strdup(name) : NULL;
}

ec_result ec_gltf_cameras_place(ec_gltf *g, const ec_placement_list *placements, ec_scene *s, const ec_log *log,
                                ec_error *err)
{
    s->cameras = calloc((size_t)placements->count + 1, sizeof *s->cameras);
    if (!s->cameras) return ec_fail(err, "%s: out of memory for cameras", g->path);
    for (uint32_t i = 0; i < placements->count; i++) {
        const ec_placement *at = &placements->items[i];
        int32_t index = g->nodes[at->node].camera;
        if (index < 0 || at->extra) continue;
        ec_camera camera = g->cameras[index];
        if (!place_camera(at, s->center, &camera)) {
            ec_warn(log, "%s: the camera at nodes[%d] stands at infinity; it is left out", g->path, at->node);
            continue;
        }
        camera.name = camera_name(g, at->node);
        s->cameras[s->camera_count++] = camera;
    }
    if (!s->camera_count) {
        s->cameras[s->camera_count++] = framing_camera(s);
        ec_note(log, "%s: no camera in the scene; using one that frames all of it", g->path);
    }
    return EC_OK;
}

ec_result ec_scene_find_camera(const ec_scene *s, const char *name_or_index, uint32_t *camera, ec_error *err)
{
    EC_FREED char **names = malloc(s->camera_count * sizeof *names); /* the strings belong to the cameras */
    if (!names) return ec_fail(err, "out of memory");
    for (uint32_t i = 0; i < s->camera_count; i++) names[i] = s->cameras[i].name;
    return ec_scene_names_find(&(ec_scene_names){names, s->camera_count}, "camera", name_or_index, camera, err);
}
