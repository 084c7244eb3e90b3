/* The scene as the buffers that kernels/shared describes. Everything is malloc'ed; free it with ec_pack_free. */
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

/* A sphere around something that bends or mirrors light sharply. */
typedef struct ec_caster {
    float centre[3], radius; /* in the recentred frame */
    float share;             /* share of the light paths that are aimed at it */
} ec_caster;

/* Lamps of one body that the light tree takes as one: a range in the table of lights. */
typedef struct ec_bulb {
    uint32_t first, count;
} ec_bulb;

typedef struct ec_pack {
    ec_scene_view plain;           /* the scene that was packed */
    ec_effects effects;            /* effects that the scene calls for; those that options call for are the caller's */
    uint32_t prim_count;
    ec_prim *prims;
    bool prims_lent;               /* owned by the payload: a processor uses them in place */
    ec_bodies bodies;              /* ranked; none unless some may be nested */
    uint32_t material_count;
    ec_material_data *materials;
    uint32_t texture_count;
    ec_texture_data *textures;     /* one per texture and encoding in use */
    size_t texel_words;
    struct ec_texels *texels;
    uint32_t place_words;
    uint32_t *places;              /* places of instances: ec_place_header and what it describes; NULL: none */
    uint64_t motion_words;
    uint32_t *motion;              /* keys of what moves (EC_MOTION_* in shared/scene_buffers.h); NULL: nothing does */
    uint64_t coplanar_words;
    uint32_t *coplanar;            /* faces that overlap in one plane (kernels/lib/coplanar.h); NULL: none */
    bool lamps_move;               /* triangles, points or spots among the lights move */
    uint32_t light_count;          /* only lights of positive power */
    ec_light_data *lights;
    uint32_t *light_source;        /* of a punctual light: its index in the scene; otherwise EC_NO_ID */
    ec_distribution_entry *light_shares; /* by light */
    uint32_t light_choices;        /* entries of light_shares: one for each light; with a tree the last one is for all lamps */
    uint32_t *light_of_prim;       /* by triangle: its place in lights, or EC_NO_ID; with a tree its lamp's trail, or 0 */
    uint32_t light_node_count;     /* 0: lights are chosen by power alone */
    ec_light_node *light_tree;
    bool by_tree;                  /* lamps are to be chosen by a light tree */
    uint32_t bulb_count;
    ec_bulb *bulbs;                /* with a tree, in order: see bulbs.h */
    uint32_t lamp_pair_count;      /* number of pairs that face opposite ways: see lamp_pairs.h */
    uint32_t *pair_of_prim;        /* by triangle: its partner's place in lights, or EC_NO_ID; NULL: no pairs */
    uint32_t lamp_node_count;      /* 0: no lamp is cut into parts */
    ec_lamp_node *lamp_nodes;      /* of lamps whose texture varies: see lamp_parts.h */
    float lamp_share;              /* share of the lamps in the power of all lights */
    bool lights_are_halved;        /* there are both lamps and lights at infinity, and each kind is chosen by half of the numbers */
    double lamp_power;             /* W of luminance, divided among lamps by their pmf */
    uint32_t light_tree_numbers;   /* how many of 2^31 numbers make light sampling use the tree */
    uint32_t caster_count;         /* 0: nothing to aim light paths at, or not asked for */
    ec_caster casters[EC_CASTERS_MOST];
    double caster_flux;            /* approximate W of luminance that lights send to casters; 0: there are none, or not asked for */
    size_t emission_words;
    uint32_t *emission;            /* as in kernels/lib/light_path.h */
    double mean_radiance;          /* of luminance, approximately, if all emitted light went through the scene's sphere */
    uint32_t environment_width, environment_height;
    float *environment_texels;     /* height + 1 rows, the first one twice: R, G, B and the scale of the patch right of and below the texel's centre
                                    * (kernels/lib/environment.h); NULL if the environment is constant */
    ec_distribution_entry *environment_table; /* of height + 1 rows of patches; then of the patches of each. NULL if it is black */
    bool environment_lent;         /* texels and table belong to the scene's environment (ec_packed_map) */
    float environment_mean[3];     /* radiance averaged over all directions */
    float environment_pmf;         /* probability that light sampling chooses the environment */
    uint64_t environment_stretch;  /* floor(2^64 / numbers that choose it), or 2^64 - 1 if it is one number (kernels/lib/choice.h) */
    float scene_radius, scene_max;
    float srgb[256];               /* linear value of each sRGB byte */
} ec_pack;

ec_result ec_pack_scene(const ec_scene *scene, ec_pack *pack, ec_error *err); /* all but the texels, on which no effect depends */
ec_result ec_pack_texels(ec_pack *pack, ec_error *err);
void ec_pack_free(ec_pack *pack); /* zero-initialised is fine */

/* The steps, in order; each fills its part of pack. */
/* Finds bodies that may lie in one another, unranked. */
ec_result ec_pack_find_bodies(const ec_scene *plain, ec_bodies *bodies, ec_error *err);
ec_result ec_pack_effects(const ec_scene *plain, const ec_bodies *bodies, ec_effects *effects, ec_error *err);
/* Adds the effects that multiple scattering needs if rough metal or glass shows. */
void ec_pack_rough(const ec_scene *plain, ec_effects *effects);
/* Do only the scans, on the scene's plain view. */
ec_result ec_scene_calls(const ec_scene *scene, ec_effects *effects, ec_error *err);
ec_result ec_scene_rough(const ec_scene *scene, ec_effects *effects, ec_error *err);
/* Finds whether anything gives light: a triangle that emits or is unlit, a punctual light, an environment. */
typedef struct ec_scene_light {
    bool any;
    uint32_t triangles; /* number of those as stored, not at each of their places */
} ec_scene_light;
ec_result ec_scene_find_light(const ec_scene *scene, ec_scene_light *light, ec_error *err);
/* For a plain scene: tell whether light may pass straight through the material somewhere, either because it is thin-walled and smooth, or
 * (is_matched) because it is a body of index 1, which bends no light. */
bool ec_pack_is_pane(const ec_scene *plain, const ec_material *m);
bool ec_pack_is_matched(const ec_scene *plain, const ec_material *m);
/* Tells whether there is a body behind the surface. */
bool ec_pack_is_body(const ec_material *m);
ec_result ec_pack_textures(const ec_scene *scene, ec_pack *pack, ec_error *err); /* lays out the texels */
ec_result ec_pack_places(const ec_scene *scene, ec_pack *pack, ec_error *err);
ec_result ec_pack_motion(const ec_scene *scene, ec_pack *pack, ec_error *err);
ec_result ec_pack_lights(const ec_scene *scene, ec_pack *pack, ec_error *err);
/* A map packed by itself, for scenes that share it: ec_environment.packed. */
typedef struct ec_packed_map {
    uint32_t width, height;
    float *texels;                 /* like environment_texels; owned */
    ec_distribution_entry *table;  /* like environment_table; owned */
    float mean[3];
    double mean_luminance;
} ec_packed_map;
ec_result ec_pack_map(const ec_environment *map, ec_packed_map *packed, ec_error *err); /* of a map with rgb; leaves *packed empty on failure */
void ec_packed_map_free(ec_packed_map *packed); /* zero-initialised is fine */
ec_result ec_pack_environment(const ec_scene *scene, ec_pack *pack, double *mean_luminance, ec_error *err);

/* When a light tree is worth its time: if lamps are far apart, relative to the scene's size and their own. Triangles of one body count as one lamp. */
#define EC_LIGHT_TREE_SPREAD 0.2 /* least diagonal of the box around them, over the scene's radius */
#define EC_LIGHT_TREE_SIZES 3.0  /* and over the size of one lamp (root mean square, weighted by power) … */
#define EC_LIGHT_TREE_BODY 0.5   /* diagonal, over the scene's radius, from which each triangle of a body is a lamp of its own */
#define EC_LIGHT_TREE_MANY 64    /* … if there are fewer lamps than this */
#define EC_LIGHT_TREE_LEAST 0.002f /* least share of all power: beside lights at infinity, less makes little noise */
/* root: of ec_lamp_bodies. */
ec_result ec_pack_wants_light_tree(const ec_pack *pack, const uint32_t *root, bool *wants, ec_error *err);
/* Makes the tree; densities in lights and prims are then those of a lamp that the tree has chosen. */
ec_result ec_pack_light_tree(ec_pack *pack, ec_error *err);

/* Tells whether there may be both lights at infinity and lamps. */
bool ec_scene_mixes_lights(const ec_scene *scene);

/* Tells whether anything bends light, or mirrors most of it, within a narrow lobe. */
bool ec_scene_casts(const ec_scene *scene);
/* Tells whether a material bends light. One that casts but does not bend mirrors it. */
bool ec_material_bends(const ec_material *material);
/* Returns by material whether one of its surfaces casts; the caller frees it. NULL if there is no memory. */
bool *ec_scene_casters(const ec_scene *scene);
/* The targets of light paths. */
typedef enum ec_aim {
    EC_AIM_CASTERS,
    EC_AIM_CASTERS_AND_SCENE, /* the scene's sphere is a target too, if there are casters */
    EC_AIM_SCENE              /* only the scene's sphere */
} ec_aim;
/* Finds casters, and which lights shine on them; to be called before there is a light tree. */
ec_result ec_pack_casters(ec_pack *pack, ec_aim aim, ec_error *err);
/* Finds only caster_flux; to be called before there is a light tree, too. */
ec_result ec_pack_caster_flux(ec_pack *pack, ec_error *err);

/* Replaces pack->lights for integrators that sum over lights at their centres: triangles edge to edge in one plane become one light, and small bodies
 * one point, with their radius in pdf_a. The environment and lights that give no light are left out. They cannot be sampled. */
ec_result ec_pack_light_centres(const ec_scene *scene, ec_pack *pack, ec_error *err);

/* Returns the index in pack->textures of a texture in one encoding; -1: none. Valid after ec_pack_textures. */
int32_t ec_pack_texture_index(const ec_scene *scene, const ec_texture_use *use, int is_srgb);

/* Computes the mean radiance of a map over all directions. */
void ec_environment_mean(const ec_environment *map, float mean[3]);

/* Returns the radiant flux, weighted by luminance; that of a directional light into a sphere of this radius. */
double ec_pack_punctual_power(const ec_light *light, double scene_radius);

#endif
