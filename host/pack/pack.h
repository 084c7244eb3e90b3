/* The scene as the byte buffers that kernels/shared describes. Everything is malloc'ed; ec_pack_free. */
#ifndef EC_PACK_PACK_H
#define EC_PACK_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "pack/bodies.h"
#include "pack/called_effects.h"
#include "pack/scene_view.h"
#include "scene/scene.h"
#include "shared/features.h"
#include "shared/light_tree.h"
#include "shared/params.h"
#include "shared/scene_buffers.h"

/* A sphere about what bends or mirrors light sharply. */
typedef struct ec_caster {
    float centre[3], radius; /* recentred frame */
    float share;             /* of the light paths that are aimed at it */
} ec_caster;

/* Lamps of one body, as the light tree takes them for one: places in the table of lights. */
typedef struct ec_bulb {
    uint32_t first, count;
} ec_bulb;

typedef struct ec_pack {
    ec_scene_view plain;           /* what was packed */
    ec_effects effects;            /* that the scene calls for (those that options call for are the caller's) */
    uint32_t prim_count;
    ec_prim *prims;
    bool prims_lent;               /* the cargo's: a processor takes them where they are */
    ec_bodies bodies;              /* in order; none unless some may be nested */
    uint32_t material_count;
    ec_material_data *materials;
    uint32_t texture_count;
    ec_texture_data *textures;     /* one per texture and encoding in use */
    size_t texel_words;
    struct ec_texels *texels;
    uint32_t place_words;
    uint32_t *places;              /* of instances: ec_place_header and what it says; NULL: there are none */
    uint64_t motion_words;
    uint32_t *motion;              /* keys of what moves (EC_MOTION_* in shared/scene_buffers.h); NULL: nothing does */
    uint64_t coplanar_words;
    uint32_t *coplanar;            /* faces that lie on one another (kernels/lib/coplanar.h); NULL: none do */
    bool lamps_move;               /* triangles, points or spots among the lights */
    uint32_t light_count;          /* only lights of positive power */
    ec_light_data *lights;
    uint32_t *light_source;        /* of a punctual one which it is of the scene's; else EC_NO_ID */
    ec_distribution_entry *light_shares; /* of the lights, in order */
    uint32_t light_choices;        /* entries of light_shares: one for each light; with a tree the last one is that of all lamps */
    uint32_t *light_of_prim;       /* a triangle's place in lights, or EC_NO_ID; with a tree its lamp's trail, or 0 */
    uint32_t light_node_count;     /* 0: lights are chosen by power alone */
    ec_light_node *light_tree;
    bool by_tree;                  /* lamps are to be chosen by a light tree */
    uint32_t bulb_count;
    ec_bulb *bulbs;                /* with a tree, in order: bulbs.h */
    uint32_t lamp_pair_count;      /* of lamps that face opposite ways: lamp_pairs.h */
    uint32_t *pair_of_prim;        /* a triangle's partner's place in lights, or EC_NO_ID; NULL: there are no pairs */
    uint32_t lamp_node_count;      /* 0: no lamp is in parts */
    ec_lamp_node *lamp_nodes;      /* of lamps whose texture varies (lamp_parts.h) */
    float lamp_share;              /* lamps' part of all lights' power */
    bool lights_are_halved;        /* are there both, lamps and lights at infinity, each of them chosen by half of all numbers? */
    double lamp_power;             /* W, of luminance: what is shared among lamps as their pmf has it */
    uint32_t light_tree_numbers;   /* of 2^31 numbers those by which light sampling goes to the tree */
    uint32_t caster_count;         /* 0: nothing for light paths to be aimed at, or nobody asked */
    ec_caster casters[EC_CASTERS_MOST];
    double caster_flux;            /* W of luminance that lights send to what bends or mirrors it sharply, about; 0: nothing does, or nobody asked */
    size_t emission_words;
    uint32_t *emission;            /* as kernels/lib/light_path.h has it */
    double mean_radiance;          /* of luminance, about, if all that lights emit went through the scene's sphere */
    uint32_t environment_width, environment_height;
    float *environment_texels;     /* height + 1 rows, the first one twice: R, G, B and the scale of the patch right of and below the
                                      texel's middle (kernels/lib/environment.h); NULL where the environment is constant */
    ec_distribution_entry *environment_table; /* of height + 1 rows of patches; then of the patches of each. NULL where it is black */
    bool environment_lent;         /* texels and table are the scene's environment's (ec_packed_map) */
    float environment_mean[3];     /* radiance over all directions */
    float environment_pmf;         /* chance that light sampling chooses the environment */
    uint64_t environment_stretch;  /* floor(2^64 / numbers that choose it), or 2^64 - 1 where it is one (kernels/lib/choice.h) */
    float scene_radius, scene_max;
    float srgb[256];               /* linear value of each sRGB byte */
} ec_pack;

ec_result ec_pack_scene(const ec_scene *scene, ec_pack *pack, ec_error *err); /* all but the texels, which say nothing of effects */
ec_result ec_pack_texels(ec_pack *pack, ec_error *err);
void ec_pack_free(ec_pack *pack); /* zero-initialised is fine */

/* The steps, in order; each fills its part of pack. */
/* Bodies that may lie in one another, in no order. */
ec_result ec_pack_find_bodies(const ec_scene *plain, ec_bodies *bodies, ec_error *err);
ec_result ec_pack_effects(const ec_scene *plain, const ec_bodies *bodies, ec_effects *effects, ec_error *err);
/* Adds the effects that multiple scattering needs where rough metal or glass shows. */
void ec_pack_rough(const ec_scene *plain, ec_effects *effects);
/* The scans alone. */
ec_result ec_scene_calls(const ec_scene *scene, ec_effects *effects, ec_error *err);
ec_result ec_scene_rough(const ec_scene *scene, ec_effects *effects, ec_error *err);
/* Does anything give light: a triangle that emits or is unlit, a punctual light, an environment? */
typedef struct ec_scene_light {
    bool any;
    uint32_t triangles; /* as stored */
} ec_scene_light;
ec_result ec_scene_find_light(const ec_scene *scene, ec_scene_light *light, ec_error *err);
/* For a plain scene: may light go straight on through it, somewhere: thin-walled and smooth, or a body of index 1, which bends none? */
bool ec_pack_is_pane(const ec_scene *plain, const ec_material *m);
bool ec_pack_is_matched(const ec_scene *plain, const ec_material *m);
/* Is there a body behind it? */
bool ec_pack_is_body(const ec_material *m);
ec_result ec_pack_textures(const ec_scene *scene, ec_pack *pack, ec_error *err); /* where texels will be */
ec_result ec_pack_places(const ec_scene *scene, ec_pack *pack, ec_error *err);
ec_result ec_pack_motion(const ec_scene *scene, ec_pack *pack, ec_error *err);
ec_result ec_pack_lights(const ec_scene *scene, ec_pack *pack, ec_error *err);
/* A map by itself, for scenes that share it: ec_environment.packed. */
typedef struct ec_packed_map {
    uint32_t width, height;
    float *texels;                 /* as environment_texels; owned */
    ec_distribution_entry *table;  /* as environment_table; owned */
    float mean[3];
    double mean_luminance;
} ec_packed_map;
ec_result ec_pack_map(const ec_environment *map, ec_packed_map *packed, ec_error *err); /* of a map with rgb; empty after a failure */
void ec_packed_map_free(ec_packed_map *packed); /* zero-initialised is fine */
ec_result ec_pack_environment(const ec_scene *scene, ec_pack *pack, double *mean_luminance, ec_error *err);

/* Is a tree worth its time: are there lamps far apart, by the scene's size and by their own? Triangles of one body are one lamp. */
#define EC_LIGHT_TREE_SPREAD 0.2 /* diagonal of the box around them, over the scene's radius */
#define EC_LIGHT_TREE_SIZES 3.0  /* and over the size of one, the root of the mean square by power … */
#define EC_LIGHT_TREE_BODY 0.5   /* diagonal of a body so large that each of its triangles is a lamp, over the scene's radius */
#define EC_LIGHT_TREE_MANY 64    /* … where there are fewer than so many */
#define EC_LIGHT_TREE_LEAST 0.002f /* of all power: beside what shines from far away less makes little noise */
/* root: of ec_lamp_bodies. */
ec_result ec_pack_wants_light_tree(const ec_pack *pack, const uint32_t *root, bool *wants, ec_error *err);
/* Makes the tree; densities in lights and prims are then those of a lamp that the tree has chosen. */
ec_result ec_pack_light_tree(ec_pack *pack, ec_error *err);

/* May there be both, lights at infinity and lamps? */
bool ec_scene_mixes_lights(const ec_scene *scene);

/* Does anything bend light, or mirror most of it, within a narrow lobe? */
bool ec_scene_casts(const ec_scene *scene);
/* Does a material bend light? One that casts and does not mirrors it. */
bool ec_material_bends(const ec_material *material);
/* By material: does a surface of it cast? To be freed; NULL without memory. */
bool *ec_scene_casters(const ec_scene *scene);
/* What light paths are aimed at. */
typedef enum ec_aim {
    EC_AIM_CASTERS,
    EC_AIM_CASTERS_AND_SCENE, /* a sphere about the scene is one too, if there are others */
    EC_AIM_SCENE              /* that alone */
} ec_aim;
/* Finds casters, and which lights shine on them; before there is a light tree. */
ec_result ec_pack_casters(ec_pack *pack, ec_aim aim, ec_error *err);
/* Finds caster_flux alone; before there is a light tree, too. */
ec_result ec_pack_caster_flux(ec_pack *pack, ec_error *err);

/* Makes pack->lights those of integrators that sum over lights at their centres: triangles in one plane, edge to edge, as one;
 * small bodies as one point, with their radius in pdf_a; without the environment, and without those of which nothing comes. Nothing samples
 * them. */
ec_result ec_pack_light_centres(const ec_scene *scene, ec_pack *pack, ec_error *err);

/* Index into pack->textures of a texture in one encoding; -1 for none. Valid after ec_pack_textures. */
int32_t ec_pack_texture_index(const ec_scene *scene, const ec_texture_use *use, int is_srgb);

/* Mean radiance of a map over all directions. */
void ec_environment_mean(const ec_environment *map, float mean[3]);

/* Radiant flux, luminance-weighted; of a directional light into a sphere of that radius. */
double ec_pack_punctual_power(const ec_light *light, double scene_radius);

#endif
