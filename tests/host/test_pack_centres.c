/* tier: quick */
/* Lights for integrators that sum over all lights: a light without power is not in the list. */
#include "pack/pack.h"
#include "textured_triangle.h"

/* Two separate triangles; the texture coordinates of one are all in the red texel of a red and green picture. */
static const float two[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 1};
static const float left_and_right[12] = {0.1f, 0, 0.4f, 0, 0.2f, 1, 0.6f, 0, 0.9f, 0, 0.7f, 1};
#define TWO(FACTOR)                                                                                                                      \
    "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],"                                                                                   \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}],"                                             \
    "'buffers':[{'byteLength':72,'uri':'@pos@'},{'byteLength':48,'uri':'@uv@'}],"                                                        \
    "'bufferViews':[{'buffer':0,'byteLength':72},{'buffer':1,'byteLength':48}],"                                                         \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':6,'type':'VEC3'},"                                                        \
    "{'bufferView':1,'componentType':5126,'count':6,'type':'VEC2'}],"                                                                    \
    "'images':[{'uri':'@png8@'}],'textures':[{'source':0}],"                                                                             \
    "'materials':[{'emissiveFactor':" FACTOR ",'emissiveTexture':{'index':0}}]}"

static void check(const char *text, uint32_t expected, const float emission[3])
{
    const blob blobs[] = {{"@pos@", two, sizeof two}, {"@uv@", left_and_right, sizeof left_and_right}, {"@png8@", png8, sizeof png8}, {0}};
    ec_error err;
    ec_pack pack;
    ec_scene *s = load_text(text, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) exit(1);
    CHECK_OK(ec_pack_scene(s, &pack, &err), err);
    CHECK_MSG(pack.light_count == 2, "%u lights that are sampled", pack.light_count); /* a little of the whole texture keeps both */
    CHECK_OK(ec_pack_light_centres(&pack.plain.scene, &pack, &err), err);
    CHECK_MSG(pack.light_count == expected, "%u centres, not %u", pack.light_count, expected);
    for (int k = 0; k < 3; k++) CHECK_NEAR(pack.lights[0].emission[k], emission[k], 1e-6);
    ec_pack_free(&pack);
    ec_scene_free(s);
}

int main(void)
{
    check(TWO("[1,0,0]"), 1, (const float[]){1, 0, 0});
    check(TWO("[0,0.5,0]"), 1, (const float[]){0, 0.5f, 0});
    check(TWO("[1,0.5,1]"), 2, (const float[]){1, 0, 0});
    TEST_END();
}
