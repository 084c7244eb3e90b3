/* tier: quick */
/* The loader's geometry: modes, winding, accessors, transforms, recentring, dropped triangles. */
#include "test_scene_files.h"

static void check_triangle_facing_z(const ec_scene *s, double sign)
{
    double normal[3];
    CHECK(s->triangle_count == 1);
    face_normal(s, 0, normal);
    CHECK_MSG(normal[2] * sign > 0, "normal z %g", normal[2]);
}

static void test_winding(void)
{
    ec_error err;
    ec_scene *s = load_text(TRIANGLE("", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) check_triangle_facing_z(s, 1);
    ec_scene_free(s);
    /* Mirrored at x = 0, the triangle still faces +z. */
    s = load_text(TRIANGLE(",'scale':[-1,1,1]", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) check_triangle_facing_z(s, 1);
    ec_scene_free(s);
    /* Mirrored at z = 0, it faces -z. */
    s = load_text(TRIANGLE(",'scale':[1,1,-1]", "", "", ""), triangle_blobs, &err);
    if (s) check_triangle_facing_z(s, -1);
    ec_scene_free(s);
}

#define STRIP "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"                              \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':%MODE%}]}],"                                         \
    "'buffers':[{'byteLength':48,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':48}],"                        \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}]}"

static void test_mode(const char *mode, const float positions[12], uint32_t triangles)
{
    char *text = replace(STRIP, "%MODE%", mode);
    const blob blobs[] = {{"@pos@", positions, 48}, {0}};
    ec_error err;
    ec_scene *s = load_text(text, blobs, &err);
    CHECK_MSG(s != NULL, "mode %s: %s", mode, err.text);
    if (s) {
        CHECK_MSG(s->triangle_count == triangles, "mode %s: %u", mode, s->triangle_count);
        double normal[3], area = 0;
        for (uint32_t i = 0; i < s->triangle_count; i++) {
            face_normal(s, i, normal);
            CHECK_MSG(normal[2] > 0, "mode %s triangle %u", mode, i);
            area += 0.5 * normal[2];
        }
        CHECK_NEAR(area, triangles == 2 ? 1 : 0.5, 1e-6);
    }
    ec_scene_free(s);
    free(text);
}

static void test_modes(void)
{
    const float strip[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, fan[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    test_mode("5", strip, 2);
    test_mode("6", fan, 2);
    test_mode("4", strip, 1); /* a fourth vertex makes no second triangle */
}

/* Base positions with vertex 2 replaced by (0, 2, 0) through a sparse accessor, with and without a base. */
static void test_sparse(const char *view, double expected_area)
{
    struct {
        uint16_t index[2];
        float value[6];
        float base[9];
    } data = {{1, 2}, {1, 0, 0, 0, 2, 0}, {0, 0, 0, 9, 9, 9, 9, 9, 9}};
    char *text = replace("{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
                         "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                         "'buffers':[{'byteLength':64,'uri':'@pos@'}],"
                         "'bufferViews':[{'buffer':0,'byteLength':4},{'buffer':0,'byteOffset':4,'byteLength':24},"
                         "{'buffer':0,'byteOffset':28,'byteLength':36}],"
                         "'accessors':[{%VIEW%'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':2,"
                         "'indices':{'bufferView':0,'componentType':5123},'values':{'bufferView':1}}}]}",
                         "%VIEW%", view);
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    ec_error err;
    ec_scene *s = load_text(text, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) {
        double normal[3];
        face_normal(s, 0, normal);
        CHECK_NEAR(0.5 * normal[2], expected_area, 1e-6);
    }
    ec_scene_free(s);
    data.index[1] = 3;
    expect_failure(text, blobs, "sparse index 3");
    free(text);
}

/* Interleaved: position (float), colour (u8 normalised), uv (u16 normalised). */
static void test_normalized_interleaved(void)
{
    struct vertex {
        float position[3];
        uint8_t color[4];
        uint16_t uv[2];
    } data[3] = {{{0, 0, 0}, {255, 51, 0, 255}, {0, 65535}}, {{1, 0, 0}, {0, 0, 0, 102}, {13107, 0}},
                 {{0, 1, 0}, {0, 0, 0, 0}, {0, 0}}};
    const blob blobs[] = {{"@pos@", data, sizeof data}, {0}};
    ec_error err;
    ec_scene *s = load_text(
        "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1,'TEXCOORD_1':2}}]}],"
        "'buffers':[{'byteLength':60,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':60,'byteStride':20}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':12,'componentType':5121,'normalized':true,'count':3,'type':'VEC4'},"
        "{'bufferView':0,'byteOffset':16,'componentType':5123,'normalized':true,'count':3,'type':'VEC2'}]}",
        blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK(s->vertex_count == 3 && s->colors && s->uv[1] && !s->uv[0] && !s->normals && !s->tangents);
    CHECK_NEAR(s->colors[0], 1, 0);
    CHECK_NEAR(s->colors[1], 0.2, 1e-7);
    CHECK_NEAR(s->colors[7], 0.4, 1e-7);
    CHECK_NEAR(s->uv[1][1], 1, 0);
    CHECK_NEAR(s->uv[1][2], 0.2, 1e-7);
    ec_scene_free(s);
}

/* A plane inclined by 45 degrees, stretched along x: normals are transformed by the inverse transpose, tangents by the matrix. */
static void test_frames(void)
{
    const float h = 0.70710678f;
    struct {
        float position[9], normal[9], tangent[12];
    } data = {{0, 0, 0, 1, 1, 0, 0, 0, 1}, {-h, h, 0, -h, h, 0, 0, 0, 0}, {h, h, 0, 1, h, h, 0, -1, NAN, 0, 0, 1}};
    const char *text = "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'scale':[%SX%,1,1]}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TANGENT':2}}]}],"
        "'buffers':[{'byteLength':120,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36},"
        "{'buffer':0,'byteOffset':36,'byteLength':36},{'buffer':0,'byteOffset':72,'byteLength':48}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'},"
        "{'bufferView':2,'componentType':5126,'count':3,'type':'VEC4'}]}";
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    const double scales[] = {3, -3, 0};
    for (int i = 0; i < 3; i++) {
        char number[32], *scaled;
        sprintf(number, "%g", scales[i]);
        scaled = replace(text, "%SX%", number);
        ec_error err;
        ec_scene *s = load_text(scaled, blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        if (s) {
            double length = sqrt(1 + scales[i] * scales[i]), face[3];
            CHECK_NEAR(s->normals[0], -1 / length * (scales[i] < 0 ? -1 : 1), 1e-6);
            CHECK_NEAR(s->normals[1], fabs(scales[i]) / length, 1e-6);
            CHECK_NEAR(s->tangents[0], scales[i] / length, 1e-6);
            CHECK_NEAR(s->tangents[3], scales[i] < 0 ? -1 : 1, 0);
            CHECK_NEAR(s->tangents[7], scales[i] < 0 ? 1 : -1, 0);
            face_normal(s, 0, face);
            double agreement = face[0] * s->normals[0] + face[1] * s->normals[1];
            CHECK_MSG(agreement < 0, "front and normal, scale %g: %g", scales[i], agreement);
            for (int k = 6; k < 9; k++) CHECK(s->normals[k] == 0); /* the zero normal stays zero */
            for (int k = 8; k < 12; k++) CHECK(s->tangents[k] == 0);
        }
        ec_scene_free(s);
        free(scaled);
    }
}

/* A metre-sized triangle at 1e6: in float its position would have steps of 6 cm; after recentring it is exact. */
static void test_recentring(void)
{
    ec_error err;
    ec_scene *s = load_text("{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':["
                            "{'translation':[1000000.125,-2000000.25,0],'children':[1,2]},{'mesh':0},{'camera':0,"
                            "'translation':[0.5,0.5,2]}],'cameras':[{'type':'perspective','perspective':{'yfov':1}}],"
                            "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                            "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
                            "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]}",
                            triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK_NEAR(s->center[0], 1000000.625, 1e-9);
    CHECK_NEAR(s->center[1], -1999999.75, 1e-9);
    for (int i = 0; i < 9; i++) CHECK_NEAR(s->positions[i], triangle_positions[i] - (i % 3 < 2 ? 0.5 : 0), 1e-9);
    CHECK_NEAR(s->cameras[0].position[0], 0, 1e-6);
    CHECK_NEAR(s->cameras[0].position[2], 2, 1e-6);
    CHECK_NEAR(s->bounds_min[0], -0.5, 0);
    CHECK_NEAR(s->bounds_max[1], 0.5, 0);
    ec_scene_free(s);
}

#define FIVE "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"                               \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"                                           \
    "'buffers':[{'byteLength':72,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':60},"                         \
    "{'buffer':0,'byteOffset':60,'byteLength':12}],"                                                                   \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'},"                                      \
    "{'bufferView':1,'componentType':5121,'count':%N%,'type':'SCALAR'}]}"

static void test_dropped(void)
{
    struct {
        float position[15];
        uint8_t index[12];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, NAN, 0, 1e9f}, {0, 1, 2, 0, 1, 1, 0, 1, 3, 0, 2, 4}};
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    char *text = replace(FIVE, "%N%", "12");
    ec_error err;
    ec_scene *s = load_text(text, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) {
        CHECK(s->triangle_count == 1 && s->dropped_degenerate == 2 && s->dropped_nonfinite == 1);
        CHECK(s->vertex_count == 3); /* vertices of dropped triangles are dropped too */
        CHECK_NEAR(s->bounds_max[2], 0, 0);
        CHECK_MSG(strstr(messages, "1 triangles are left out: their positions are NaN") != NULL, "%s", messages);
    }
    ec_scene_free(s);
    for (int i = 0; i < 15; i += 3) data.position[i] = INFINITY;
    expect_failure(text, blobs, "nothing to render: of 4 triangles, 0 have no area and 4 have positions that are NaN");
    memset(data.position, 0, sizeof data.position);
    expect_failure(text, blobs, "nothing to render: of 4 triangles, 4 have no area");
    data.index[11] = 5;
    expect_failure(text, blobs, "index 5 (entry 11 of accessors[1]) is out of range");
    free(text);
}

static void test_unused_vertices_are_left_out(void)
{
    struct {
        float position[15];
        uint8_t index[12];
    } data = {{0, 0, 0, 1e6f, 1e6f, 1e6f, 1, 0, 0, 0, 1, 0, -1e6f, 0, 0}, {0, 2, 3}};
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    char *text = replace(FIVE, "%N%", "3");
    ec_error err;
    ec_scene *s = load_text(text, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) CHECK(s->vertex_count == 3 && s->bounds_max[0] == 0.5f);
    ec_scene_free(s);
    free(text);
}

/* Two small triangles 4e37 apart: finite, but no picture can be computed at such distances. */
static void test_far_apart(void)
{
    ec_error err;
    ec_scene *s = load_text(TRIANGLE("},{'mesh':0,'translation':[4e37,0,0]", "", "", ",'scene':0"), triangle_blobs, &err);
    CHECK_MSG(s && s->triangle_count == 1, "%s", err.text); /* the scene lists only the first */
    ec_scene_free(s);
    s = load_text(TRIANGLE(",'children':[1]},{'mesh':0,'translation':[4e37,0,0]", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s && s->triangle_count == 1 && s->dropped_nonfinite == 1, "%s", err.text);
    if (s) CHECK_NEAR(s->center[0], 0.5, 1e-9);
    ec_scene_free(s);
}

static void test_odd_values(void)
{
    const float data[21] = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* colours */ 2, -1, NAN, 0.5f, 0, 1, 1, 1, 1, /* unused */ 0, 0, 0};
    const blob blobs[] = {{"@pos@", data, sizeof data}, {0}};
    ec_error err;
    ec_scene *s = load_text("{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],"
                            "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1}}]}],"
                            "'buffers':[{'byteLength':84,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':84}],"
                            "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                            "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,'type':'VEC3'}]}", blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    const float expected[8] = {1, 0, 0, 1, 0.5f, 0, 1, 1};
    for (int i = 0; i < 8; i++) CHECK_NEAR(s->colors[i], expected[i], 0);
    CHECK_MSG(strstr(messages, "3 values of vertex colours are NaN or out of 0..1, the first in meshes[0]; they are clamped\n") != NULL, "%s", messages);
    CHECK_MSG(!strstr(messages, "texture coordinates"), "%s", messages);
    ec_scene_free(s);
}

static void test_singular_transforms(void)
{
    ec_error err;
    ec_scene *s = load_text(TRIANGLE(",'scale':[1,1,0]", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s && s->triangle_count == 1, "%s", err.text); /* flat anyway */
    ec_scene_free(s);
    expect_failure(TRIANGLE(",'scale':[0,1,1]", "", "", ""), triangle_blobs, "nothing to render");
    expect_failure(TRIANGLE(",'scale':[1e38,1e38,1e38]", "", "", ""), triangle_blobs, "nothing to render");
}

int main(void)
{
    test_winding();
    test_modes();
    test_sparse("", 1);
    test_sparse("'bufferView':2,", 1);
    test_normalized_interleaved();
    test_frames();
    test_recentring();
    test_dropped();
    test_unused_vertices_are_left_out();
    test_far_apart();
    test_odd_values();
    test_singular_transforms();
    TEST_END();
}
