#include "gltf/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"
#include "gltf/flatten.h"

struct ec_model {
    ec_gltf *gltf;
    double place[16];
    bool failed; /* out of memory */
};

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static ec_model exhausted = {.failed = true}; /* stands for a model that could not be allocated */

ec_model *ec_model_new(void)
{
    ec_model *m = calloc(1, sizeof *m);
    if (!m) return &exhausted;
    m->gltf = calloc(1, sizeof *m->gltf);
    m->failed = !m->gltf;
    ec_model_place(m, NULL);
    if (m->gltf) m->gltf->path = "model";
    return m;
}

void ec_model_free(ec_model *m)
{
    if (!m || m == &exhausted) return;
    ec_gltf_free(m->gltf);
    free(m);
}

/* Appends an item to an array of the document; returns NULL if there is no memory. */
static void *append(ec_model *m, void *array, uint32_t *count, size_t size, const void *item)
{
    void *items; /* `array` is the address of a pointer of some type */
    memcpy(&items, array, sizeof items);
    items = m->failed ? NULL : realloc(items, (*count + 1) * size);
    if (!items) {
        m->failed = true;
        return NULL;
    }
    memcpy(array, &items, sizeof items);
    return memcpy((char *)items + size * (*count)++, item, size);
}
#define APPEND(model, list, one, ...) append(model, &(model)->gltf->list, &(model)->gltf->one##_count, sizeof(__VA_ARGS__), &(__VA_ARGS__))

int32_t ec_model_material(ec_model *m, const ec_material *material)
{
    if (m->failed) return -1;
    ec_material copy = *material;
    copy.name = NULL;
    APPEND(m, materials, material, copy);
    return (int32_t)m->gltf->material_count - 1;
}

ec_material ec_material_lambert(double albedo, double radiance)
{
    ec_material m = ec_material_default();
    m.metallic = m.specular = 0;
    for (int c = 0; c < 3; c++) m.base_color[c] = (float)albedo, m.emission[c] = (float)radiance;
    return m;
}

ec_material ec_material_glass(double ior, double roughness, double absorption)
{
    ec_material m = ec_material_default();
    m.metallic = 0;
    m.roughness = (float)roughness;
    m.transmission = 1;
    m.volume = true;
    m.ior = (float)ior;
    for (int k = 0; k < 3; k++) m.absorption[k] = (float)absorption;
    return m;
}

void ec_model_place(ec_model *m, const double matrix[16])
{
    if (m != &exhausted) memcpy(m->place, matrix ? matrix : identity, sizeof m->place);
}

/* Adds a node with the matrix `local` (NULL: the identity) below the current place. */
static void add_node(ec_model *m, const double *local, int32_t mesh, int32_t camera, int32_t light)
{
    ec_gltf_node node = {.mesh = mesh, .skin = -1, .camera = camera, .light = light};
    const double *inner = local ? local : identity;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++)
            for (int k = 0; k < 4; k++) node.local[4 * column + row] += m->place[4 * k + row] * inner[4 * column + k];
    int32_t index = m->failed ? 0 : (int32_t)m->gltf->node_count;
    APPEND(m, nodes, node, node);
    if (!m->failed) APPEND(m, roots, root, index);
}

/* Returns the index of a new accessor with its own buffer; -1 if there is no data. */
static int32_t add_accessor(ec_model *m, const void *data, uint64_t count, uint32_t components, uint32_t type)
{
    if (!data || m->failed) return -1;
    size_t bytes = (size_t)count * components * 4;
    uint8_t *copy = malloc(bytes ? bytes : 1);
    if (!copy) {
        m->failed = true;
        return -1;
    }
    memcpy(copy, data, bytes);
    ec_gltf_buffer buffer = {copy, bytes, copy};
    if (!APPEND(m, buffers, buffer, buffer)) {
        free(copy);
        return -1;
    }
    ec_gltf_view view = {.buffer = (int32_t)m->gltf->buffer_count - 1, .length = bytes};
    ec_gltf_accessor accessor = {.view = (int32_t)m->gltf->view_count, .count = count, .component_type = type, .components = components,
                                 .sparse = {.index_view = -1, .value_view = -1}};
    APPEND(m, views, view, view);
    APPEND(m, accessors, accessor, accessor);
    return m->failed ? -1 : (int32_t)m->gltf->accessor_count - 1;
}

void ec_model_add(ec_model *m, int32_t material, const ec_model_mesh *mesh)
{
    ec_gltf_primitive primitive = {.mode = EC_GLTF_TRIANGLES, .material = material, .draco_view = -1, .streams = {{-1, -1, -1, -1, -1, -1}}};
    primitive.streams.of[EC_POSITION] = add_accessor(m, mesh->positions, mesh->vertex_count, 3, EC_GLTF_FLOAT);
    primitive.streams.of[EC_NORMAL] = add_accessor(m, mesh->normals, mesh->vertex_count, 3, EC_GLTF_FLOAT);
    primitive.streams.of[EC_TANGENT] = add_accessor(m, mesh->tangents, mesh->vertex_count, 4, EC_GLTF_FLOAT);
    primitive.streams.of[EC_UV] = add_accessor(m, mesh->uv, mesh->vertex_count, 2, EC_GLTF_FLOAT);
    primitive.indices = add_accessor(m, mesh->indices, mesh->index_count, 1, EC_GLTF_UINT);
    ec_gltf_mesh one = {.primitives = malloc(sizeof primitive), .primitive_count = 1};
    if (!one.primitives || m->failed || !APPEND(m, meshes, mesh, one)) {
        free(one.primitives);
        m->failed = true;
        return;
    }
    *one.primitives = primitive;
    add_node(m, NULL, (int32_t)m->gltf->mesh_count - 1, -1, -1);
}

void ec_model_repeat(ec_model *m)
{
    if (!m->failed && m->gltf->mesh_count) add_node(m, NULL, (int32_t)m->gltf->mesh_count - 1, -1, -1);
}

void ec_model_instancing(ec_model *m, ec_instancing instancing)
{
    if (!m->failed) m->gltf->instancing = instancing;
}

/* Computes the matrix of a node that looks along its -z, with y as far up as possible. */
static void looking(const double at[3], const double target[3], double local[16])
{
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; k++) z[k] = at[k] - target[k];
    ec_normalize(z);
    ec_cross((double[3]){fabs(z[1]) > 0.9, fabs(z[1]) <= 0.9, 0}, z, x);
    ec_normalize(x);
    ec_cross(z, x, y);
    memcpy(local, identity, 16 * sizeof *local);
    for (int k = 0; k < 3; k++) {
        local[k] = x[k];
        local[4 + k] = y[k];
        local[8 + k] = z[k];
        local[12 + k] = at[k];
    }
}

void ec_model_camera(ec_model *m, ec_camera_type type, const double at[3], const double target[3], double size)
{
    ec_camera camera = {.type = type, .yfov = (float)size, .xmag = (float)size, .ymag = (float)size};
    double local[16];
    if (m->failed) return;
    looking(at, target, local);
    APPEND(m, cameras, camera, camera);
    add_node(m, local, -1, (int32_t)m->gltf->camera_count - 1, -1);
}

void ec_model_light(ec_model *m, const ec_light *light, const double at[3], const double target[3])
{
    double local[16];
    if (m->failed) return;
    looking(at, target, local);
    APPEND(m, lights, light, *light);
    add_node(m, local, -1, -1, (int32_t)m->gltf->light_count - 1);
}

ec_result ec_model_scene(ec_model *m, ec_scene **scene, ec_error *err)
{
    *scene = NULL;
    const ec_scene_choice all = {0};
    ec_result result = m && !m->failed ? ec_scene_from_gltf(&all, m->gltf, scene, NULL, err)
                                       : ec_fail(err, "out of memory for a model");
    ec_model_free(m);
    return result;
}
