/* Lights that a direction which is not aimed at them would hardly ever meet: lamps of one material and about one radiance, where a texture varies
 * parts of them; and the brightest parts of an environment map. They are copies, so that what was packed may go. */
#ifndef EC_RARE_LIGHTS_H
#define EC_RARE_LIGHTS_H

#include "film/rare.h"
#include "pack/pack.h"
#include "shared/params.h"

enum { EC_RARE_LAMPS = 32, EC_RARE_LAMPS_IN_ALL = 384, EC_RARE_LIGHTS = 96 };
enum { EC_RARE_SUNS = 4, EC_RARE_AIMS = 24, EC_RARE_POINTS = 24, EC_RARE_SOURCES = EC_RARE_SUNS + EC_RARE_AIMS + EC_RARE_POINTS,
       EC_RARE_SKY = 32 }; /* directions that stand for what of an environment is no sun */
#define EC_RARE_COMMON 0.02 /* chance beyond which every picture meets its light */
enum { EC_RARE_EDGES = 1 << 13, EC_RARE_NEAR_EDGES = 1 << 9 };

/* A lamp's triangle or a part of one, which stands for `weight` of its group. */
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

/* A light that a ray can be aimed at: one far away, that is a directional light, a small part of an environment or a direction of its sky; a lamp, which
 * is taken to shine from its middle; a point or spot light. */
typedef enum ec_rare_source_type { EC_RARE_FAR, EC_RARE_LAMP, EC_RARE_POINT } ec_rare_source_type;
typedef struct ec_rare_source {
    char name[EC_RARE_NAME];
    ec_rare_source_type type;
    float direction[3]; /* unit; EC_RARE_FAR: towards it, in the map's frame if it is on one; a lamp's normal; the way that a spot light shines */
    float middle[3];    /* of a lamp, point or spot light */
    bool is_on_map, two_sided;
    uint32_t material;  /* of a lamp */
    double irradiance;  /* luminance, of a surface that faces it; EC_RARE_LAMP and _POINT: at a distance of 1, where both face each other */
    double radiance;    /* of a lamp */
    double solid_angle; /* that a direction of the sky stands for; of others 0 */
    double cos_inner, cos_outer; /* of a spot light; below -1: a point light */
    double range;       /* of a point or spot light, metres; 0: infinite */
    double power;       /* of a point or spot light */
} ec_rare_source;

typedef struct ec_rare_lights {
    uint32_t count;
    double power;                    /* of all lights of the scene */
    double flux;                     /* W that they send to casters; 0: not asked for */
    float radius;                    /* of a sphere around the scene */
    float *straight;                 /* by material: share of light that goes straight on through it, if its factors say so */
    float *sharp;                    /* by material: share of light that it sends on in a narrow lobe, head-on, if its factors say so */
    bool *casts;                     /* by material: light paths are aimed at it, where they are traced */
    ec_rare_light *lights;           /* owned, as all here; NULL: nothing in the scene is small */
    uint32_t *triangle_material;     /* by triangle's id as stored */
    uint32_t stored_count, material_count;
    char (*materials)[EC_RARE_NAME]; /* names */
    ec_shape *shapes;
    ec_placed *placed;
    uint32_t placed_count;
    ec_rare_source sources[EC_RARE_SOURCES]; /* the strongest of each type */
    uint32_t source_count;
    ec_rare_source sky[EC_RARE_SKY]; /* the environment without its suns: directions all around */
    uint32_t sky_count;
    float (*edges)[3];               /* points just beside edges of triangles, outside of those; in no order */
    uint32_t edge_count;
} ec_rare_lights;

/* Finds such lights; empty where the scene has none. */
ec_result ec_rare_lights_find(const ec_pack *pack, ec_rare_lights *lights, ec_error *err);
void ec_rare_lights_free(ec_rare_lights *lights); /* zero-initialised or freed is fine */

/* Returns whether it shines from no direction more than from others, so that no ray can be aimed at it. */
static inline bool ec_rare_light_is_all_around(const ec_rare_light *light)
{
    return !light->lamp_count && light->direction[0] == 0 && light->direction[1] == 0 && light->direction[2] == 0;
}

/* Sets the direction, in the scene, towards an environment's part that is not all around. */
void ec_rare_light_direction(const ec_rare_light *light, const ec_params *params, float direction[3]);

/* Turns a direction from the environment's map to the scene. */
void ec_rare_turn_from_map(const float map[3], const ec_params *params, float direction[3]);

/* Sets the unit direction in which the source lies from a point. */
void ec_rare_source_aim(const ec_rare_source *source, const ec_params *params, const float point[3], float towards[3]);

/* Returns the irradiance of a surface that faces the source, at a point that its light comes to along a direction. */
double ec_rare_source_irradiance(const ec_rare_source *source, const float point[3], const float along[3]);

/* Returns the number under which a triangle is stored, by the id that hits have; *placed: where it stands, NULL if as it is stored. */
uint32_t ec_rare_stored_of(const ec_rare_lights *lights, uint32_t id, const ec_placed **placed);

/* Returns the material of a triangle by the id that hits have. */
uint32_t ec_rare_material_of(const ec_rare_lights *lights, uint32_t id);

#endif
