/* A scene made in memory, piece by piece. It goes the way of one from a file: nodes are multiplied out in double, the centre is
 * subtracted, triangles without area are dropped and counted.
 *
 * Nothing here fails before ec_model_scene: out of memory is remembered until then. Metres, radiance. */
#ifndef EC_GLTF_MODEL_H
#define EC_GLTF_MODEL_H

#include "scene/material_fields.h"

typedef struct ec_model ec_model;

ec_model *ec_model_new(void); /* never NULL */
void ec_model_free(ec_model *model); /* NULL is fine */

/* Pure Lambert that emits from its front. */
ec_material ec_material_lambert(double albedo, double radiance);
/* A body of glass; absorption: 1/m, of every channel. */
ec_material ec_material_glass(double ior, double roughness, double absorption);
int32_t ec_model_material(ec_model *model, const ec_material *material); /* its index; copied, names are not */

/* Where what is added from now on stands: the node's matrix, column major as in glTF, applied to all of it. NULL: where it says. */
void ec_model_place(ec_model *model, const double matrix[16]);

/* 3 floats a vertex; normals, tangents (4 a vertex) and uv (2 a vertex) may be NULL. */
typedef struct ec_model_mesh {
    uint32_t vertex_count, index_count;
    const float *positions, *normals, *tangents, *uv;
    const uint32_t *indices; /* NULL: vertices in threes */
} ec_model_mesh;
void ec_model_add(ec_model *model, int32_t material, const ec_model_mesh *mesh);

/* The mesh that was added last once more, where the place is now. */
void ec_model_repeat(ec_model *model);
/* Which meshes are kept once; auto where nothing is said. */
void ec_model_instancing(ec_model *model, ec_instancing instancing);

/* Front: where u x v points. */
void ec_model_quad(ec_model *model, int32_t material, const double at[3], const double u[3], const double v[3]);
/* Six quads that look outwards, or inwards. */
void ec_model_box(ec_model *model, int32_t material, const double low[3], const double high[3], bool inwards);
/* An octahedron divided `levels` times (4^levels x 8 triangles), vertices on the sphere; smooth: with normals. Looks outwards. */
void ec_model_sphere(ec_model *model, int32_t material, const double center[3], double radius, int levels, bool smooth);

/* From `at` to `target`. Perspective: size is the vertical field of view in radians; orthographic: half the height. */
void ec_model_camera(ec_model *model, ec_camera_type type, const double at[3], const double target[3], double size);
/* Its position and direction are the model's to set. */
void ec_model_light(ec_model *model, const ec_light *light, const double at[3], const double target[3]);

/* Ends the model, which is freed in any case. */
ec_result ec_model_scene(ec_model *model, ec_scene **scene, ec_error *err);

#endif
