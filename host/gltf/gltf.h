/* A glTF file as plain C data, read by the shim, with all indices checked to be in range. Inside host/gltf/ only; the rest of the program sees
 * ec_scene. Indices are int32_t, -1 where the file names none. */
#ifndef EC_GLTF_GLTF_H
#define EC_GLTF_GLTF_H

#include "scene/scene.h"

/* glTF's own codes for component types and primitive modes. */
enum { EC_GLTF_BYTE = 5120, EC_GLTF_UBYTE, EC_GLTF_SHORT, EC_GLTF_USHORT, EC_GLTF_UINT = 5125, EC_GLTF_FLOAT };
enum { EC_GLTF_POINTS, EC_GLTF_LINES, EC_GLTF_LINE_LOOP, EC_GLTF_LINE_STRIP, EC_GLTF_TRIANGLES, EC_GLTF_STRIP,
       EC_GLTF_FAN };

typedef struct ec_gltf_buffer {
    const uint8_t *data; /* NULL: the file has none, which is an error only when somebody reads it */
    uint64_t length;
    uint8_t *owned;      /* NULL where data lies in the .glb's own bytes */
} ec_gltf_buffer;

/* EXT_meshopt_compression and KHR_meshopt_compression: the source of a view's bytes. */
typedef enum ec_meshopt_mode { EC_MESHOPT_NONE, EC_MESHOPT_ATTRIBUTES, EC_MESHOPT_TRIANGLES, EC_MESHOPT_INDICES } ec_meshopt_mode;
typedef enum ec_meshopt_filter {
    EC_MESHOPT_NO_FILTER,
    EC_MESHOPT_OCTAHEDRAL,
    EC_MESHOPT_QUATERNION,
    EC_MESHOPT_EXPONENTIAL,
    EC_MESHOPT_COLOR
} ec_meshopt_filter;
typedef struct ec_gltf_meshopt {
    ec_meshopt_mode mode; /* EC_MESHOPT_NONE: not compressed */
    ec_meshopt_filter filter;
    int32_t buffer;
    uint64_t offset, length, count;
    uint32_t stride;
} ec_gltf_meshopt;

typedef struct ec_gltf_view {
    int32_t buffer;
    uint64_t offset, length;
    uint32_t stride; /* 0 = packed */
    ec_gltf_meshopt packed;
    uint8_t *owned;  /* unpacked bytes, once the view has been read */
} ec_gltf_view;

typedef struct ec_gltf_sparse {
    uint64_t count;
    int32_t index_view, value_view;
    uint64_t index_offset, value_offset;
    uint32_t index_type;
} ec_gltf_sparse;

typedef struct ec_gltf_accessor {
    int32_t view;
    uint64_t offset, count;
    uint32_t component_type;
    uint32_t components; /* 1..4, 16 for MAT4; 0 for other matrices, which nothing uses */
    bool normalized;
    ec_gltf_sparse sparse; /* count 0: not sparse */
    /* Set by ec_gltf_accessor_open: */
    bool open;
    const uint8_t *data; /* NULL: all zeros */
    uint64_t stride;
    uint8_t *owned;      /* of a sparse accessor: base and replacements merged */
} ec_gltf_accessor;

/* Accessors of a vertex' attributes, or of what a morph target adds to them, indexed by the streams of scene.h. */
typedef struct ec_gltf_streams {
    int32_t of[EC_STREAMS];
} ec_gltf_streams;

typedef struct ec_gltf_draco {
    int32_t accessor;
    uint32_t id; /* of the attribute in the compressed data */
} ec_gltf_draco;

typedef struct ec_gltf_primitive {
    int32_t mode, material, indices;
    ec_gltf_streams streams, *targets;
    int32_t *joints, *weights; /* accessors with four influences each */
    uint32_t target_count, influence_sets;
    int32_t draco_view; /* KHR_draco_mesh_compression; -1: none */
    ec_gltf_draco *draco;
    uint32_t draco_count;
    /* Set by ec_gltf_primitive_prepare; scene_material by ec_gltf_materials_assign: */
    bool prepared, drawn, left_over;   /* drawn: has triangles; left_over: has corners that make no triangle */
    uint64_t triangle_count;
    uint32_t lowest, highest;          /* range of the vertices used */
    uint32_t scene_material;
} ec_gltf_primitive;

typedef struct ec_gltf_mesh {
    char *name;
    ec_gltf_primitive *primitives;
    float *weights; /* of morph targets, for nodes that have none of their own */
    uint32_t primitive_count, weight_count;
} ec_gltf_mesh;

typedef struct ec_gltf_skin {
    int32_t *joints; /* nodes */
    uint32_t joint_count;
    int32_t inverse_bind; /* accessor; -1: identities */
} ec_gltf_skin;

/* EXT_mesh_gpu_instancing: accessors with one element for each instance of the node's mesh. */
typedef struct ec_gltf_instancing {
    bool used;
    int32_t translation, rotation, scale;
} ec_gltf_instancing;

typedef struct ec_gltf_node {
    char *name;
    double local[16]; /* column major, as in the file */
    int32_t mesh, skin, camera, light;
    int32_t *children;
    float *weights;
    uint32_t child_count, weight_count;
    ec_gltf_instancing instances;
    bool hidden; /* by KHR_node_visibility or MSFT_lod; its children are then hidden too */
} ec_gltf_node;

/* Encoded pixels: a bufferView, or a URI whose form was checked but which was not opened. */
typedef struct ec_gltf_image {
    char *name, *uri;
    int32_t view;
} ec_gltf_image;

typedef struct ec_gltf_texture {
    int32_t image; /* -1: none, or only one in a format that is not supported */
    ec_wrap wrap_s, wrap_t;
    bool nearest;
    bool is_gloss;    /* KHR_materials_pbrSpecularGlossiness: alpha is glossiness, of which roughness is made */
    float glossiness; /* the factor of that alpha */
} ec_gltf_texture;

/* EXT_lights_image_based: the light of the shown scene. Its other mips and irradiance coefficients are blurred versions of these faces. */
typedef struct ec_gltf_image_light {
    bool used;
    int32_t index;         /* in the file, for messages */
    int32_t faces[6];      /* images of the sharpest mip, in the order +x, -x, +y, -y, +z, -z */
    uint32_t size;         /* pixels per side, as the file says */
    double rotation[4];    /* quaternion that turns directions of the cube to those of the scene */
    double intensity;      /* >= 0 */
} ec_gltf_image_light;

/* The origin of a vertex of the scene. */
typedef struct ec_source {
    uint32_t placement, primitive, vertex;
} ec_source;
#define EC_STILL UINT32_MAX /* as placement: the vertex does not move */

typedef struct ec_gltf {
    const char *path;  /* for messages; owned by the caller */
    char *folder;      /* base of URIs: "" or with a trailing slash */
    uint8_t *file;     /* the whole .glb, if buffers point into it */
    ec_gltf_buffer *buffers;
    ec_gltf_view *views;
    ec_gltf_accessor *accessors;
    ec_gltf_mesh *meshes;
    ec_gltf_skin *skins;
    ec_gltf_node *nodes;
    ec_gltf_image *images;
    ec_gltf_texture *textures;
    ec_material *materials; /* their texture uses hold indices of `textures` */
    ec_camera *cameras;     /* unplaced */
    ec_light *lights;       /* unplaced */
    uint32_t buffer_count, view_count, accessor_count, mesh_count, skin_count, node_count, image_count, texture_count,
        material_count, camera_count, light_count;
    ec_gltf_image_light image_light;
    int32_t *roots;         /* nodes of the scene to show */
    uint32_t root_count;
    ec_instancing instancing; /* chosen by the caller, like the next two */
    double point_size;        /* see thicken.h */
    bool follow_links;        /* symbolic links may lead out of the folder */
    void *tree;             /* gltf_shim.cpp's posable, with which the file can be posed again; NULL: it cannot */
    uint32_t stored_accessors, stored_meshes; /* counts of the file itself; deformed copies made for a pose follow behind */
    ec_image *decoded;      /* by image, kept for all scenes of an animation; NULL: not kept */
    uint32_t decoded_count;
    uint8_t digest[32];     /* SHA-256 over all files of the document, if choice->frame */
    bool *animated;         /* by node: a channel moves it; NULL: nothing is animated */
    bool blurs;             /* some channel moves something within the shutter */
    bool frame;             /* one frame of a sequence: see ec_scene_choice */
    uint32_t shutter_keys;  /* the most keyframes that a channel has within the shutter */
    ec_source *sources;     /* by vertex of the scene, while a scene with a shutter is made */
    bool quantized;         /* KHR_mesh_quantization: allows integer positions, normals and tangents */
    ec_scene_contents contents;
} ec_gltf;

/* gltf_shim.cpp: parses the file, checks its structure and index ranges, and loads the buffers. Throws no exception. */
ec_result ec_gltf_read(const char *path, const ec_scene_choice *choice, ec_gltf **gltf, const ec_log *log, ec_error *err);
void ec_gltf_free(ec_gltf *gltf); /* NULL is fine */

/* Poses a document that was read with choice->animated at another moment, choice->at, without reading or decoding anything again. Restores what
 * scenes are made of: nodes, weights and, where a channel moves them, cameras and lights; with `whole` also what the last scene has taken, such as
 * materials. */
ec_result ec_gltf_pose(ec_gltf *gltf, const ec_scene_choice *choice, bool whole, const ec_log *log, ec_error *err);
void ec_gltf_tree_free(ec_gltf *gltf);
void ec_gltf_unpose(ec_gltf *gltf);        /* gltf_free.c: frees nodes and deformed copies */
void ec_gltf_free_looks(ec_gltf *gltf);    /* frees textures, materials, cameras and lights */

/* gltf_digest.c: adds these bytes, or all buffers and images in other files, to the digest. */
void ec_gltf_digest_add(ec_gltf *gltf, const uint8_t *bytes, uint64_t length);
void ec_gltf_digest_parts(ec_gltf *gltf);

/* load.c: copies the choice with at set to the middle of its shutter, if it has one. */
ec_result ec_settle_moment(const char *path, const ec_scene_choice *choice, ec_scene_choice *moment, ec_error *err);
/* Does everything after reading. Takes strings and materials from the document, which still belongs to the caller. */
ec_result ec_scene_from_gltf(const ec_scene_choice *choice, ec_gltf *gltf, ec_scene **scene, const ec_log *log, ec_error *err);

/* gltf_tree.c: makes a label such as nodes[3] "name" for messages; name may be NULL. */
typedef struct ec_label {
    char text[128];
} ec_label;
ec_label ec_label_of(const char *list, uint32_t index, const char *name);
/* Computes translation x rotation x scale, column major. A quaternion of any length will do; zero is no rotation. */
void ec_gltf_compose(const double translation[3], const double rotation[4], const double scale[3], double matrix[16]);

/* gltf_uri.c */
ec_result ec_gltf_uri_check(const char *where, const char *uri, ec_error *err); /* fails if the URI leaves the folder */
char *ec_gltf_uri_file(const char *uri); /* malloc'ed, relative to the folder; NULL: not a file that would be read */
ec_result ec_gltf_uri_load(const ec_gltf *gltf, const char *where, const char *uri, uint8_t **bytes, uint64_t *length, ec_error *err);
ec_result ec_gltf_file_load(const char *file, uint8_t **bytes, uint64_t *length, ec_error *err);

/* gltf_accessor.c: all reading of buffers goes through here. Open an accessor before reading it; `what` names it in messages, e.g.
 * "meshes[2].primitives[0] POSITION". */
ec_result ec_gltf_check_views(const ec_gltf *gltf, ec_error *err);
ec_result ec_gltf_accessor_open(ec_gltf *gltf, int32_t accessor, const char *what, ec_error *err);
void ec_gltf_accessor_floats(const ec_gltf_accessor *accessor, uint64_t element, uint32_t count, float *out);
uint32_t ec_gltf_accessor_index(const ec_gltf_accessor *accessor, uint64_t element);

/* gltf_primitive.c: checks a primitive's accessors and indices once; afterwards its triangles can be read freely. A primitive without triangles, such
 * as points and lines, is left with drawn = false. `where` is e.g. "meshes[2] \"box\" primitives[0]". */
ec_result ec_gltf_primitive_prepare(ec_gltf *gltf, ec_gltf_primitive *primitive, const char *where, ec_error *err);
/* Checks what deforms a prepared primitive in the same way: one of its morph targets; its joints and weights. */
ec_result ec_gltf_target_prepare(ec_gltf *gltf, const ec_gltf_primitive *primitive, uint32_t target, const char *where,
                                 ec_error *err);
ec_result ec_gltf_influences_prepare(ec_gltf *gltf, const ec_gltf_primitive *primitive, const char *where, ec_error *err);
void ec_gltf_primitive_triangle(const ec_gltf *gltf, const ec_gltf_primitive *primitive, uint64_t triangle,
                                uint32_t vertices[3]);

#endif
