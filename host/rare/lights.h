/* Lights that a direction which nobody aimed would hardly ever meet: groups of lamps of one material, and the brightest parts of an
 * environment map. Copied, so that what was packed may go. */
#ifndef EC_RARE_LIGHTS_H
#define EC_RARE_LIGHTS_H

#include "film/rare.h"
#include "pack/pack.h"
#include "shared/params.h"

enum { EC_RARE_LAMPS = 32, EC_RARE_LIGHTS = 96 };

/* A lamp's triangle, which stands for `weight` of its group. */
typedef struct ec_rare_lamp {
    float corner[3], edges[2][3], middle[3], normal[3]; /* recentred frame; the normal is unit */
    uint32_t prim;
    float area, weight;
    bool two_sided;
} ec_rare_lamp;

typedef struct ec_rare_light {
    char name[EC_RARE_NAME];
    uint32_t material;     /* of lamps; UINT32_MAX: part of the environment */
    double radiance;       /* luminance; of an environment's part the mean */
    double power;          /* W, of luminance; an environment's into a sphere around the scene */
    double solid_angle;    /* of an environment's part */
    float direction[3];    /* towards it on the map, unit; zero: it lies all around */
    ec_rare_lamp lamps[EC_RARE_LAMPS];
    uint32_t lamp_count;
} ec_rare_light;

typedef struct ec_rare_lights {
    uint32_t count;
    double power;                    /* of all lights of the scene */
    float radius;                    /* of a sphere around the scene */
    float *sharp;                    /* by material: share of light that it sends on in a narrow lobe, head-on, if its factors say so */
    ec_rare_light *lights;           /* owned, as all here; NULL: nothing in the scene is small */
    uint32_t *triangle_material;     /* by triangle's id as stored */
    uint32_t stored_count, material_count;
    char (*materials)[EC_RARE_NAME]; /* names */
    ec_shape *shapes;
    ec_placed *placed;
    uint32_t placed_count;
} ec_rare_lights;

/* Empty where the scene has no such light. */
ec_result ec_rare_lights_find(const ec_pack *pack, ec_rare_lights *lights, ec_error *err);
void ec_rare_lights_free(ec_rare_lights *lights); /* zero-initialised or freed is fine */

/* Towards an environment's part, in the scene. */
void ec_rare_light_direction(const ec_rare_light *light, const ec_params *params, float direction[3]);

/* The material of a triangle by the id that rays know. */
uint32_t ec_rare_material_of(const ec_rare_lights *lights, uint32_t id);

#endif
