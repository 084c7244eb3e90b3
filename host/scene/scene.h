/* The scene as plain data: flattened triangles with materials, lights and cameras.
 * Nothing here knows glTF, acceleration structures or OpenCL. */
#ifndef EC_SCENE_SCENE_H
#define EC_SCENE_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "scene/placed.h"
#include "shared/material_fields.h"

/* Decoded pixels, row 0 at the top (glTF's v = 0), always four channels. Exactly one of rgba8 and rgba16 is set. */
typedef struct ec_image {
    uint32_t width, height;
    uint8_t *rgba8;   /* 4 * width * height; owned, or part of `texels` */
    struct ec_texels *texels; /* the block that contains rgba8, of which this image is a user; NULL: it has memory of its own */
    uint16_t *rgba16; /* 4 * width * height, owned; only if the file has more than 8 bits */
    char *name;       /* for messages, owned, may be NULL */
    bool lent;        /* everything belongs to an animation, which outlives the scene */
    bool has_range;   /* the next two are known (texture_range.h); otherwise they are determined when needed */
    uint16_t least[4], most[4]; /* by channel, as stored */
} ec_image;

void ec_image_free(ec_image *image); /* leaves zeros; does not free pixels that are lent */

/* Radiance and intensity are limited to this, with a warning, so that what sampling divides by stays within float. */
#define EC_RADIANCE_MOST 1e30f

typedef enum ec_wrap { EC_WRAP_REPEAT, EC_WRAP_CLAMP, EC_WRAP_MIRROR } ec_wrap;

typedef struct ec_texture {
    uint32_t image;       /* index into ec_scene.images */
    ec_wrap wrap_s, wrap_t;
    bool nearest;         /* magnification filter NEAREST; otherwise bilinear */
} ec_texture;

/* The largest texture coordinate, and factor of its transform: their products fit into floats. Beyond 2^24 a texture shows a single texel anyway. */
#define EC_UV_MOST 1e18f

/* A material's use of a texture; texture < 0: none. */
typedef struct ec_texture_use {
    int32_t texture;
    uint32_t uv_set;      /* 0 or 1 */
    float transform[6];   /* KHR_texture_transform, row major 2x3: (u', v') = M (u, v, 1) */
} ec_texture_use;

typedef enum ec_alpha_mode { EC_ALPHA_OPAQUE, EC_ALPHA_MASK, EC_ALPHA_BLEND } ec_alpha_mode;

/* Numbers such as base_color and emission; shared/material_fields.h explains each. */
#define EC_FLOATS_1(field) float field;
#define EC_FLOATS_3(field) float field[3];
#define EC_FLOATS_4(field) float field[4];
#define EC_NUMBERS(field, floats, value, least, most, slot, channel, effect, has, path) EC_FLOATS_##floats(field)
#define EC_NOT_NUMBERS(type, field)
#define EC_NOT_FLOATS(field)
typedef struct ec_material {
    EC_MATERIAL_FIELDS(EC_NUMBERS, EC_NUMBERS, EC_NOT_NUMBERS, EC_NOT_FLOATS)
    bool volume;               /* KHR_materials_volume with a thickness: bounds a body that refracts; otherwise thin-walled */
    ec_alpha_mode alpha_mode;
    bool double_sided;
    bool unlit;                /* KHR_materials_unlit */
    ec_texture_use textures[EC_SLOT_COUNT]; /* by ec_slot */
    char *name;                /* owned, may be NULL */
} ec_material;
/* Tells whether its factors let it emit; a texture may still be black. */
static inline bool ec_emits(const ec_material *m) { return m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0; }
/* Tells whether light is refracted; otherwise it is thin-walled or opaque. */
static inline bool ec_refracts(const ec_material *m) { return m->transmission > 0 && m->volume && m->ior > 0; }
/* Tells whether it encloses a body that light enters diffusely. */
static inline bool ec_bounds(const ec_material *m) { return m->diffuse_transmission > 0 && m->volume; }

/* KHR_lights_punctual, in the scene's recentred frame. 1 cd is taken as 1 W/sr, 1 lx as 1 W/m^2. */
typedef enum ec_light_type { EC_LIGHT_POINT, EC_LIGHT_SPOT, EC_LIGHT_DIRECTIONAL } ec_light_type;
typedef struct ec_light {
    ec_light_type type;
    float position[3];
    float direction[3];        /* unit, in which the light travels */
    float intensity[3];        /* colour x intensity: W/sr, or W/m^2 for directional */
    float range;               /* metres; 0 = infinite */
    float cos_inner, cos_outer;
    uint32_t moves;            /* 1 + index into ec_scene.motion.lights; 0: stands still */
    char *name;                /* of its node, owned, may be NULL */
} ec_light;

typedef enum ec_camera_type { EC_CAMERA_PERSPECTIVE, EC_CAMERA_ORTHOGRAPHIC } ec_camera_type;
typedef struct ec_camera {
    ec_camera_type type;
    float position[3];                     /* recentred frame */
    float right[3], up[3], forward[3];     /* orthonormal; forward: where it looks (glTF's -z) */
    float yfov;                            /* radians, perspective */
    float aspect;                          /* width / height; 0 = the image's */
    float xmag, ymag;                      /* half extents, orthographic */
    uint32_t moves;                        /* like that of ec_light */
    char *name;                            /* owned, may be NULL */
} ec_camera;

/* The motion while the shutter is open: keys at equal times from opening to closing, with straight lines in between. The first vertices and triangles
 * of the scene are those that move; their entries in the scene, and everything else in it, are as in the middle of the exposure. Keys of one thing
 * are adjacent. */
typedef struct ec_motion {
    uint32_t segments;              /* a power of two, one less than the number of keys; 0: nothing moves, and the rest is undefined */
    uint32_t vertex_count, triangle_count;
    float *positions;               /* 3 per key, segments + 1 keys per vertex; owned, like everything here */
    float *normals, *tangents;      /* likewise, 3 per key; NULL if the scene has none */
    float *swept;                   /* 6 per triangle: the box over all its keys, lowest corner first */
    uint32_t light_count, camera_count;
    ec_light *lights;               /* keys of those that move; only position and direction are valid, names are NULL */
    ec_camera *cameras;             /* likewise; all of the camera is valid */
    double opens, closes;           /* seconds in the animation */
    double deviation;               /* largest distance from the true motion, relative to the box that the mesh sweeps, at the moments examined */
} ec_motion;
#define EC_MOTION_SEGMENTS_MOST 128u
#define EC_MOTION_DEVIATION (1.0 / 2000) /* segments are doubled until the deviation is less */

/* Radiance from infinitely far away. rgb == NULL means `constant` everywhere.
 * Equirectangular, oriented as in Khronos' sample viewer and three.js: a unit direction (x, y, z) lies at u = 0.5 + atan2(z, x) / (2 pi), v = acos(y)
 * / pi, with u = 0 at the left edge and v = 0 at the top (row 0 is +y). So the picture's centre is +x, a quarter to the right of it +z, to the left
 * -z, and both edges are -x. */
typedef struct ec_environment {
    uint32_t width, height;
    float *rgb;           /* 3 * width * height, linear, finite and >= 0, owned */
    float constant[3];
    bool lent;            /* rgb belongs to somebody else, who outlives the scene */
    const struct ec_packed_map *packed; /* what host/pack has made of rgb, likewise lent; NULL: nothing yet */
    bool turned;          /* by `turn`, row major: from directions of the map, as above, to those of the scene */
    float turn[9];
} ec_environment;

/* Names in a file, some of which can be chosen from. All owned; a name may be NULL. */
typedef struct ec_scene_names {
    char **names;
    uint32_t count;
} ec_scene_names;
typedef struct ec_scene_contents {
    ec_scene_names scenes, variants, animations;
    ec_scene_names extensions, ignored; /* ignored: extensions that are not supported */
    uint32_t scene;        /* index of the shown one */
    double *seconds;       /* durations of the animations; NaN: the file does not tell */
} ec_scene_contents;
void ec_scene_contents_free(ec_scene_contents *contents);

/* Finds `wanted` by name, else by index. `what` names the kind in the message, which lists those there are. */
ec_result ec_scene_names_find(const ec_scene_names *names, const char *what, const char *wanted, uint32_t *index, ec_error *err);

/* Triangles from id `first` up to the next part's belong to one node, given by its index in the file. */
typedef struct ec_part {
    uint32_t first, node; /* EC_NO_NODE: none */
} ec_part;
#define EC_NO_NODE UINT32_MAX

typedef struct ec_scene {
    /* Vertices; optional streams are NULL if no primitive has them. A vertex without a normal or tangent has zeros there (kernels then use the
     * geometric normal, or derivatives of uv); one without a colour has ones. */
    uint32_t vertex_count;
    float *positions;     /* 3 per vertex, world space minus `center` */
    float *normals;       /* 3 per vertex, unit or zero */
    float *tangents;      /* 4 per vertex, w = handedness +-1, or all zero */
    float *uv[2];         /* 2 per vertex */
    float *colors;        /* 4 per vertex, linear */
    /* Triangles: counter-clockwise seen from the front, also under mirrored nodes. None is degenerate or non-finite. */
    uint32_t triangle_count;
    uint32_t *indices;            /* 3 per triangle */
    uint32_t *triangle_material;  /* per triangle */
    /* Meshes kept once: the triangles from shapes[0].first on, in coordinates of their own. None of them emits. */
    uint32_t shape_count, placed_count;
    ec_shape *shapes;
    ec_placed *placed;            /* sorted by id, beginning at shapes[0].first */
    uint32_t part_count;
    ec_part *parts;               /* sorted by id, including placed triangles */
    char **node_names;            /* node_count names: of the node, or of its mesh; each may be NULL; all owned */
    uint32_t *node_roots;         /* by node: the root above it, or itself; owned */
    ec_motion motion;
    bool whole;                   /* no acceleration structure may cut triangles, so that bits are the same with and without instances, rebuilt or refitted */
    uint32_t material_count;
    ec_material *materials;       /* at least one, glTF's default */
    uint32_t texture_count;
    ec_texture *textures;
    uint32_t image_count;
    ec_image *images;
    uint32_t light_count;
    ec_light *lights;
    uint32_t camera_count;
    ec_camera *cameras;           /* at least one: a framing camera is made if the file has none */
    uint32_t default_camera;
    ec_environment environment;
    bool has_environment;         /* false: black */
    /* For views that leave effects out (pack/without.c): shadow rays end at panes; bodies do not displace one another. */
    bool solid_shadows, bodies_apart;
    double center[3];             /* subtracted from world coordinates */
    float bounds_min[3], bounds_max[3]; /* recentred */
    bool spans;                   /* for a frame: the box of its whole animation is known, in world coordinates */
    double span_min[3], span_max[3];
    /* Shown by `eclat info`. */
    uint32_t mesh_count, node_count, instance_count;
    uint32_t dropped_degenerate, dropped_nonfinite;  /* numbers of triangles left out */
    uint32_t skipped_primitives;                     /* number of those without POSITION */
    char *lost_image;              /* owned: why the first image that is taken as white could not be read; NULL: all could */
    ec_scene_contents contents;
} ec_scene;

/* Selects what to show of a file, by name or index; NULL and false: the file's defaults. */
typedef struct ec_scene_choice {
    const char *scene, *variant;
    const char *animation;     /* may be "all"; NULL: the first */
    double at;                 /* seconds into the animation */
    bool animated;             /* false: everything is as stored */
    bool at_given;             /* the time was asked for explicitly */
    bool shutter;              /* open from `opens` to `closes`, in seconds; `at` is then set to their middle */
    double opens, closes;
    ec_instancing instancing;  /* which meshes are kept once */
    double point_size;         /* width of points and lines, in pixels of a picture 512 high seen by the first camera; 0: 1 pixel */
    bool follow_links;         /* buffers and images may be symbolic links that lead out of the scene's folder */
    bool frame;                /* of a sequence: if an animation may move meshes, no triangle is cut, at any of its moments */
} ec_scene_choice;

/* The streams of a vertex by number, and the floats of each. */
enum { EC_POSITION, EC_NORMAL, EC_TANGENT, EC_COLOR, EC_UV, EC_STREAMS = EC_UV + 2 };
static const uint8_t ec_stream_width[EC_STREAMS] = {3, 3, 4, 4, 2, 2};
static inline float *ec_scene_stream(const ec_scene *s, int stream)
{
    float *const all[EC_STREAMS] = {s->positions, s->normals, s->tangents, s->colors, s->uv[0], s->uv[1]};
    return all[stream];
}

/* Allocates triangles, and vertices with the streams whose bits are set; other streams become NULL. Returns false if out of memory. */
bool ec_scene_allocate(ec_scene *scene, unsigned streams, size_t vertices, size_t triangles);
void ec_scene_trim(ec_scene *scene); /* gives back unused memory */
void ec_scene_free_geometry(ec_scene *scene);

void ec_scene_free(ec_scene *scene); /* NULL is fine */
/* Frees data that are only needed to make a payload: vertices, triangles, pixels of images and of the environment. Counts, names, cameras, lights and
 * materials stay. */
void ec_scene_drop_data(ec_scene *scene);
void ec_motion_free(ec_motion *motion); /* leaves an empty motion */

/* Returns the number of triangles that are stored in world coordinates: those before the shapes'. */
static inline uint32_t ec_scene_flat_count(const ec_scene *s) { return s->shape_count ? s->shapes[0].first : s->triangle_count; }
/* Returns the number of triangles that rays can meet. */
static inline uint64_t ec_scene_met_count(const ec_scene *s)
{
    const ec_placed *last = s->placed_count ? &s->placed[s->placed_count - 1] : NULL;
    return last ? (uint64_t)last->id + s->shapes[last->shape].count : s->triangle_count;
}

/* Returns the node of a triangle by its id; -1: unknown. */
int64_t ec_scene_node_of(const ec_scene *s, uint32_t id);

/* Makes a scene with every instance written out, to the last bit, for code that knows only triangles. It shares data with `scene`; free it with
 * ec_scene_written_free. Fails if there is not enough memory. */
ec_result ec_scene_write_out(const ec_scene *scene, ec_scene *written, ec_error *err);
void ec_scene_written_free(ec_scene *written);

/* Replaces the environment. spec is a file (.hdr or .exr, equirectangular), "R,G,B", or one of built_in.h. Non-finite and negative values become 0,
 * those above EC_RADIANCE_MOST become that; a warning counts them. */
ec_result ec_scene_set_environment(ec_scene *scene, const char *spec, const ec_log *log, ec_error *err);

/* Turns it about +y, counter-clockwise seen from above. */
void ec_environment_turn(ec_environment *environment, double degrees);

/* Multiplies the environment by `strength` (0 removes it), and turns it about +y, counter-clockwise seen from above. There must be an environment. */
void ec_scene_adjust_environment(ec_scene *scene, double degrees, double strength, const ec_log *log);

/* A camera's position and target, in the file's coordinates. */
typedef struct ec_viewpoint {
    double eye[3], target[3], up[3]; /* metres; up: a direction */
    double fov;                      /* vertical field of view in degrees; 0: parallel rays */
    double tall;                     /* for parallel rays: height of the picture in metres */
} ec_viewpoint;

/* Makes the camera at a viewpoint, in the frame recentred by `center`. Its aspect is the image's, its name NULL. Fails if eye and target coincide, or
 * a number is not finite. All cameras given as numbers are made here: the same numbers give the same bits. */
ec_result ec_camera_look(const ec_viewpoint *viewpoint, const double center[3], ec_camera *camera, ec_error *err);

/* Returns the distance of the scene's middle along the camera's axis; 1 if it is behind the camera. */
double ec_camera_reach(const ec_scene *scene, const ec_camera *camera);

/* The inverse of ec_camera_look, up to rounding; the target is `distance` in front of the eye. */
void ec_camera_viewpoint(const ec_camera *camera, const double center[3], double distance, ec_viewpoint *viewpoint);

/* Finds a camera by name, else by index; the error lists those there are. */
ec_result ec_scene_find_camera(const ec_scene *scene, const char *name_or_index, uint32_t *camera, ec_error *err);

#endif
