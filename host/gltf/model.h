/* Makes a scene in memory, piece by piece. It is treated like one from a file: nodes are multiplied out in double, the centre is subtracted,
 * triangles without area are dropped and counted.
 *
 * No function but ec_model_scene fails: out of memory is remembered until then. Units are metres and radiance. */
#ifndef EC_GLTF_MODEL_H
#define EC_GLTF_MODEL_H

#include "scene/material_fields.h"

typedef struct ec_model ec_model;

ec_model *ec_model_new(void); /* never NULL */
void ec_model_free(ec_model *model); /* NULL is fine */

/* Returns a Lambertian material that emits from its front. */
ec_material ec_material_lambert(double albedo, double radiance);
/* Returns the material of a glass body; absorption: 1/m, equal in all channels. */
ec_material ec_material_glass(double ior, double roughness, double absorption);
int32_t ec_model_material(ec_model *model, const ec_material *material); /* returns its index; copied, but without its name */

/* Sets the matrix (column major, as in glTF) of the node to which everything added from now on belongs. NULL: the identity. */
void ec_model_place(ec_model *model, const double matrix[16]);

/* 3 floats per vertex; normals, tangents (4 per vertex) and uv (2 per vertex) may be NULL. ec_model_add copies all of it. */
typedef struct ec_model_mesh {
    uint32_t vertex_count, index_count;
    const float *positions, *normals, *tangents, *uv;
    const uint32_t *indices; /* NULL: every three vertices are a triangle */
} ec_model_mesh;
void ec_model_add(ec_model *model, int32_t material, const ec_model_mesh *mesh);

/* Adds the last mesh once more, at the current place. */
void ec_model_repeat(ec_model *model);
/* Sets which meshes are kept once; the default is auto. */
void ec_model_instancing(ec_model *model, ec_instancing instancing);

/* Adds a parallelogram whose front faces u x v. */
void ec_model_quad(ec_model *model, int32_t material, const double at[3], const double u[3], const double v[3]);
/* Adds six quads that face outwards or inwards. */
void ec_model_box(ec_model *model, int32_t material, const double low[3], const double high[3], bool inwards);
/* Adds an octahedron subdivided `levels` times (4^levels x 8 triangles), vertices on the sphere, facing outwards; smooth: with normals. */
void ec_model_sphere(ec_model *model, int32_t material, const double center[3], double radius, int levels, bool smooth);

/* Adds a camera at `at` that looks at `target`. size: the vertical field of view in radians if perspective, half the height in metres if
 * orthographic. */
void ec_model_camera(ec_model *model, ec_camera_type type, const double at[3], const double target[3], double size);
/* Adds a light; its position and direction are set by the model. */
void ec_model_light(ec_model *model, const ec_light *light, const double at[3], const double target[3]);

/* Makes the scene, and frees the model in any case. */
ec_result ec_model_scene(ec_model *model, ec_scene **scene, ec_error *err);

#endif
