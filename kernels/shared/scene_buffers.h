/* Geometry, materials, lights and textures as the kernels read them: in fours of words, so records are laid out in fours and
 * the word offsets are named beside the structs. Streams that are not made of fours (indices, normals) have 16 spare bytes
 * behind their end. */
#ifndef EC_SHARED_SCENE_BUFFERS_H
#define EC_SHARED_SCENE_BUFFERS_H

#include "material_fields.h"
#include "types.h"

/* One triangle, in scene order: the hit's id is the index, but on an instance. */
typedef struct ec_prim {
    ec_float v0[3];
    ec_uint material;
    ec_float v1[3];
    ec_float light_pdf_a; /* pmf of choosing this triangle as a light / its area, 1/m^2; 0: not a light */
    ec_float v2[3];
    ec_uint flags;        /* EC_PRIM_* */
} ec_prim;
EC_ASSERT_SIZE(ec_prim, 48);
#define EC_PRIM_WORDS 12
#define EC_PRIM_SINGLE_SIDED 1u /* camera rays pass through its back */
#define EC_PRIM_ALPHA 2u        /* coverage must be looked up */
#define EC_PRIM_PANE 4u         /* may let light go straight on (lib/pane.h) */
#define EC_PRIM_PARTS 8u        /* shift: first ec_lamp_node of a lamp in parts; else 0 */

/* The places of instances, for shading: a header, an ec_place each, and behind them their first ids once more, side by side, to be
 * searched. */
typedef struct ec_place_header {
    ec_uint count;
    ec_uint first_id;   /* of the first instance: triangles before it belong to none */
    ec_uint ids;        /* word where the first ids begin */
    ec_uint step;       /* largest power of two below count, or 0 */
} ec_place_header;
EC_ASSERT_SIZE(ec_place_header, 16);
typedef struct ec_place {
    ec_float place[3][4];  /* rows: world = place x (point, 1) */
    ec_float normal[3][4]; /* rows: transforms normals; the fourth column is 0 */
    ec_uint id;            /* of its first triangle, as hits have it */
    ec_uint first;         /* index of that triangle's ec_prim */
    ec_uint turned;        /* 1: mirrored; corners 1 and 2 change places */
    ec_uint pad;
} ec_place;
EC_ASSERT_SIZE(ec_place, 112);
#define EC_PLACE_WORDS 28
#define EC_PLACE_NORMAL 12
#define EC_PLACE_ID 24

/* The motion of the scene, in words: a header; four words for each moving triangle, the vertices of its corners; then streams with four words a key, all keys
 * of a vertex side by side: positions, normals, tangents. A light has its positions first, then as many directions. */
#define EC_MOTION_SEGMENTS 0u  /* one fewer than keys, a power of two */
#define EC_MOTION_TRIANGLES 1u /* the scene's first ones */
#define EC_MOTION_VERTICES 2u
#define EC_MOTION_POSITIONS 3u /* words where the streams begin */
#define EC_MOTION_NORMALS 4u
#define EC_MOTION_TANGENTS 5u
#define EC_MOTION_LIGHTS 6u
#define EC_MOTION_HEADER 8u
/* A camera's key: the first vectors of ec_params. */
#define EC_CAMERA_VECTORS 6u

typedef struct ec_texture_slot {
    ec_int texture;      /* -1: none */
    ec_uint uv_set;
    ec_float transform[6]; /* (u', v') = M (u, v, 1), row major */
} ec_texture_slot;
EC_ASSERT_SIZE(ec_texture_slot, 32);

/* EC_WORD_sheen: where a field lies in a material's record. */
#define EC_MATERIAL_WORD(field, floats, value, least, most, slot, channel, effect, has, path) \
    EC_WORD_##field, EC_WORD_##field##_last = EC_WORD_##field + floats - 1,
#define EC_MATERIAL_NO_WORD(field, floats, value, least, most, slot, channel, effect, has, path)
#define EC_MATERIAL_OWN_WORD(type, field) EC_WORD_##field,
#define EC_MATERIAL_OWN_WORDS(field) EC_WORD_##field, EC_WORD_##field##_last = EC_WORD_##field + 2,
enum ec_material_word {
    EC_MATERIAL_FIELDS(EC_MATERIAL_WORD, EC_MATERIAL_NO_WORD, EC_MATERIAL_OWN_WORD, EC_MATERIAL_OWN_WORDS) EC_WORD_slots,
    EC_MATERIAL_WORDS = EC_WORD_slots + 8 * EC_SLOT_COUNT
};

#define EC_MATERIAL_FLOATS_1(field) ec_float field;
#define EC_MATERIAL_FLOATS_3(field) ec_float field[3];
#define EC_MATERIAL_FLOATS_4(field) ec_float field[4];
#define EC_MATERIAL_FIELD(field, floats, value, least, most, slot, channel, effect, has, path) EC_MATERIAL_FLOATS_##floats(field)
#define EC_MATERIAL_OWN_FIELD(type, field) type field;
typedef struct ec_material_data {
    EC_MATERIAL_FIELDS(EC_MATERIAL_FIELD, EC_MATERIAL_NO_WORD, EC_MATERIAL_OWN_FIELD, EC_MATERIAL_FLOATS_3)
    ec_texture_slot slots[EC_SLOT_COUNT];
} ec_material_data;
EC_ASSERT(sizeof(ec_material_data) == 4 * EC_MATERIAL_WORDS && EC_WORD_slots % 4 == 0, ec_a_material_is_made_of_fours);
#define EC_MATERIAL_DOUBLE_SIDED 1u
#define EC_MATERIAL_EMISSIVE 2u
#define EC_MATERIAL_UNLIT 4u
#define EC_MATERIAL_MASK 8u
#define EC_MATERIAL_BLEND 16u
#define EC_SMOOTH_ALPHA 1e-4f /* GGX of less width is narrower than float directions resolve: a mirror */
#define EC_MATERIAL_REFRACTS 32u /* a body, not a thin wall */
#define EC_MATERIAL_BOUNDS 64u   /* likewise, for what is transmitted diffusely */
#define EC_MATERIAL_NESTED 128u  /* a body that may lie in another; if light is bent, its f0 is the specular colour alone */
#define EC_MATERIAL_MATCHED 256u /* a body whose walls shadow rays pass where the index is the same on both sides (lib/pane.h) */
#define EC_BODIES_MOST 32u       /* materials of such bodies */

/* A texture is a view of an image's texels. */
typedef struct ec_texture_data {
    ec_uint offset;       /* first texel, in words of the texel buffer: RGBA8 has one a texel, float four */
    ec_uint width, height;
    ec_uint flags;        /* EC_TEXTURE_* */
} ec_texture_data;
EC_ASSERT_SIZE(ec_texture_data, 16);
#define EC_TEXTURE_WRAP_S 0u /* shift of two bits: 0 repeat, 1 clamp, 2 mirror */
#define EC_TEXTURE_WRAP_T 2u
#define EC_TEXTURE_NEAREST 16u
#define EC_TEXTURE_FLOAT 32u /* four linear floats a texel: from images with more than 8 bits */

enum ec_light_kind { EC_KIND_TRIANGLE, EC_KIND_POINT, EC_KIND_SPOT, EC_KIND_DIRECTIONAL, EC_KIND_ENVIRONMENT };

/* One light, 16 words. Triangle: a, b, c are its vertices. Punctual: a = position, b = direction (unit, as the light
 * travels), c = (1 / (cos_inner - cos_outer), cos_outer, 1 / range or 0). Environment: nothing. */
typedef struct ec_light_data {
    ec_float a[3], b[3], c[3];
    ec_float emission[3]; /* triangle: radiance factor; point, spot: W/sr; directional: W/m^2 */
    ec_uint kind;         /* ec_light_kind | EC_LIGHT_TWO_SIDED | EC_LIGHT_TEXTURED, … */
    ec_uint prim;         /* triangle: its id; else EC_NO_ID */
    ec_float pmf;         /* probability of choosing this light */
    ec_float pdf_a;       /* triangle: pmf / area */
} ec_light_data;
EC_ASSERT_SIZE(ec_light_data, 64);
#define EC_LIGHT_WORDS 16
#define EC_LIGHT_KIND_MASK 7u
#define EC_LIGHT_TWO_SIDED 8u
#define EC_LIGHT_TEXTURED 16u
#define EC_LIGHT_MOVES 32u /* punctual: prim is its number among the lights that move. A triangle that moves has its pmf in place of a density, here
                            * and in ec_prim, since its area is that at the path's time */
#define EC_LIGHT_COATED 64u /* dimmed by a clear coat, depending on the angle */
#define EC_LIGHT_OPEN 128u  /* coverage leaves some of it open */
#define EC_LIGHT_PAIR_FIRST 256u  /* the next light is a triangle that faces the opposite way … */
#define EC_LIGHT_PAIR_SECOND 512u /* … and the previous one is: whichever of the two faces the point is chosen */
#define EC_LIGHT_PARTS 10u  /* shift: first node of its parts, or 0 */

/* A triangle divided into four: three at its corners, and the fourth between them, turned by half a turn. Each child is chosen by the numbers, of
 * 2^32, from its first one to the next child's; the last child's end where the parent's do. Node 0 is unused. */
typedef struct ec_lamp_node {
    ec_uint first[3]; /* of children 1, 2 and 3 */
    ec_uint link;     /* 16 times the node of the first child that is divided itself, after which those of the others follow, + a bit for each such child */
} ec_lamp_node;
EC_ASSERT_SIZE(ec_lamp_node, 16);
#define EC_LAMP_NODE_WORDS 4
#define EC_LAMP_NODES_MOST 0x01000000u
#define EC_LAMP_PARTS_NUMBERS 0xe0000000u /* numbers that choose a part; by the others the lamp is sampled as a whole */

/* Entry of a distribution that is sampled by inversion: its share of the 32-bit numbers begins at `first` and ends where the next entry's begins,
 * the last one's at 2^32. guide: the entry of the last of the numbers r for which r * n >> 32 is this entry's index. */
typedef struct ec_distribution_entry {
    ec_uint first;
    ec_uint guide;
} ec_distribution_entry;
EC_ASSERT_SIZE(ec_distribution_entry, 8);

#endif
