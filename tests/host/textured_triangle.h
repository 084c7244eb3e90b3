/* A triangle with coordinates, pictures and a material of the test's own, as a file. */
#ifndef EC_TEST_TEXTURED_TRIANGLE_H
#define EC_TEST_TEXTURED_TRIANGLE_H

#include "test_scene_files.h"

/* A 2x1 PNG: 8 bits RGB (red, green) and 16 bits grey (0x0102, 0xfffe). Made with Python's zlib. */
static const unsigned char png8[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 8, 2, 0, 0, 0,
    123, 64, 232, 221, 0, 0, 0, 15, 73, 68, 65, 84, 120, 156, 99, 248, 207, 192, 192, 240, 159, 1, 0, 7,
    255, 1, 255, 1, 127, 137, 167, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130};
static const unsigned char png16[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 16, 0, 0, 0, 0,
    129, 217, 252, 21, 0, 0, 0, 13, 73, 68, 65, 84, 120, 156, 99, 96, 100, 250, 255, 15, 0, 3, 11, 2, 1,
    132, 145, 232, 19, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130};
static const float triangle_uv[6] = {0, 0, 1, 0, 0, 1};

/* A triangle with TEXCOORD_0; MATERIAL and ROOT are inserted; images 0 = png8, 1 = png16, 2 = broken. */
#define TEXTURED(MATERIAL, ROOT)                                                                                       \
    "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],"                                                                 \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}],"                           \
    "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':24,'uri':'@uv@'}],"                                      \
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':24}],"                                       \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"                                      \
    "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC2'}],"                                                  \
    "'images':[{'uri':'@png8@'},{'uri':'@png16@'},{'uri':'data:image/png;base64,AAAA','name':'broken'},"               \
    "{'uri':'missing.png'}],"                                                                                          \
    "'samplers':[{'magFilter':9728,'wrapS':33071,'wrapT':33648}],"                                                     \
    "'textures':[{'source':0,'sampler':0},{'source':1},{'source':2},{'sampler':0},{'source':3},{'source':0}],"         \
    "'materials':[{'name':'m'" MATERIAL "}]" ROOT "}"
static const blob textured_blobs[] = {{"@pos@", triangle_positions, 36}, {"@uv@", triangle_uv, 24},
                                      {"@png8@", png8, sizeof png8}, {"@png16@", png16, sizeof png16}, {0}};

static inline ec_scene *load(const char *text)
{
    ec_error err;
    ec_scene *s = load_text(text, textured_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) exit(1);
    return s;
}

#endif
