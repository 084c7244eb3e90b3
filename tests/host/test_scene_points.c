/* tier: quick */
/* Points and lines become closed surfaces, as wide as the camera sees them, in every mode and with every transform. */
#include "test_scene_files.h"

static const double pi = 3.14159265358979323846;

/* Corners of a square, so far apart that their balls do not touch. */
static const float corners[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const uint8_t colors[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
static const uint16_t order[4] = {0, 1, 3, 2};
static const blob blobs[] = {{"@pos@", corners, sizeof corners}, {"@col@", colors, sizeof colors}, {"@idx@", order, sizeof order}, {0}};

/* The camera is 4 before the square, where its picture is 2 x 4 x tan 0.25 high. */
#define SCENE(NODE, PRIMITIVE, CAMERA)                                                                                              \
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0" NODE "},{'translation':[0.5,0.5,4]" CAMERA "}],"     \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1}" PRIMITIVE "}]}],'buffers':[{'byteLength':48,'uri':'@pos@'}," \
    "{'byteLength':16,'uri':'@col@'},{'byteLength':8,'uri':'@idx@'}],'bufferViews':[{'buffer':0,'byteLength':48},"                  \
    "{'buffer':1,'byteLength':16},{'buffer':2,'byteLength':8}],'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}," \
    "{'bufferView':1,'componentType':5121,'normalized':true,'count':4,'type':'VEC4'},"                                              \
    "{'bufferView':2,'componentType':5123,'count':4,'type':'SCALAR'}],'cameras':[{'type':'perspective','perspective':{'yfov':0.5}}," \
    "{'type':'orthographic','orthographic':{'xmag':3,'ymag':2,'znear':0,'zfar':9}}]}"

typedef struct measures {
    double area, volume, width; /* of all balls, from the leftmost to the rightmost place */
    bool faces_out;
} measures;

static measures measure(const ec_scene *s)
{
    measures m = {.faces_out = true};
    double least = 1e9, most = -1e9;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        double normal[3], a[3], b[3], c[3];
        face_normal(s, t, normal);
        world_corner(s, t, 0, a), world_corner(s, t, 1, b), world_corner(s, t, 2, c);
        m.area += 0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        for (int k = 0; k < 3; k++) m.volume += normal[k] * (a[k] + b[k] + c[k]) / 18;
        for (uint32_t i = 0; i < 3; i++) {
            const float *n = s->normals + 3 * s->indices[3 * t + i];
            m.faces_out = m.faces_out && normal[0] * (double)n[0] + normal[1] * (double)n[1] + normal[2] * (double)n[2] > 0;
            double corner[3];
            world_corner(s, t, i, corner);
            least = fmin(least, corner[0]), most = fmax(most, corner[0]);
        }
    }
    m.width = most - least;
    return m;
}

static ec_scene *load(const char *json, double size)
{
    ec_error err;
    wanted.point_size = size;
    ec_scene *s = load_text(json, blobs, &err);
    wanted.point_size = 0;
    CHECK_MSG(s && !strstr(messages, "W "), "%s%s", err.text, messages);
    return s;
}

/* Averaged over all directions, a convex body shows a quarter of its surface: that of a ball of the requested width. */
static void test_width(void)
{
    static const double sizes[] = {0, 3, 20};
    static const char *const nodes[] = {SCENE("", ",'mode':0", ",'camera':0"), SCENE(",'scale':[1,1,-1]", ",'mode':0", ",'camera':0"),
                                        SCENE("", ",'mode':0", ",'camera':1")};
    for (size_t k = 0; k < 3; k++)
        for (size_t i = 0; i < 3; i++) {
            ec_scene *s = load(nodes[k], sizes[i]);
            const double high = k == 2 ? 4 : 8 * tan(0.25), radius = 0.5 * (sizes[i] > 0 ? sizes[i] : 1) * high / 512;
            if (!s) continue;
            measures m = measure(s);
            CHECK_MSG(m.faces_out, "node %zu", k);
            CHECK_NEAR(m.area / (4 * 4 * pi * radius * radius), 1, 1e-4);
            CHECK_NEAR(m.volume / (4 * 4 / 3.0 * pi * radius * radius * radius), 1, sizes[i] > 8 ? 0.02 : 0.09);
            CHECK_NEAR(m.width, 1 + 2 * radius, 0.2 * radius);
            CHECK(s->triangle_count == (sizes[i] > 8 ? 4 * 224u : 4 * 48u));
            ec_scene_free(s);
        }
}

/* Without a camera, one pixel of the framing camera's picture, to the precision of the framed box's growth. */
static void test_framed(void)
{
    ec_scene *s = load(SCENE("", ",'mode':0", ""), 0);
    if (s) CHECK_NEAR(sqrt(measure(s).area / (4 * 4 * pi)), sqrt(0.5) / cos(pi / 8) / 512, 1e-5);
    ec_scene_free(s);
}

static void test_modes(void)
{
    static const struct {
        const char *json;
        uint32_t parts;
        double length;
    } cases[] = {{SCENE("", ",'mode':1", ",'camera':0"), 2, 2},
                 {SCENE("", ",'mode':2", ",'camera':0"), 4, 4},
                 {SCENE("", ",'mode':3", ",'camera':0"), 3, 3},
                 {SCENE("", ",'mode':3,'indices':2", ",'camera':0"), 3, 2 + 1.4142135623730951},
                 {SCENE(",'scale':[2,2,2],'translation':[-0.5,-0.5,0]", ",'mode':2", ",'camera':0"), 4, 8}};
    const double radius = 0.5 * 8 * tan(0.25) / 512;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ec_scene *s = load(cases[i].json, 1);
        if (!s) continue;
        measures m = measure(s);
        CHECK_MSG(s->triangle_count == cases[i].parts * 64 && m.faces_out, "case %zu: %u", i, s->triangle_count);
        CHECK_NEAR(m.area / (2 * pi * radius * cases[i].length + cases[i].parts * 4 * pi * radius * radius), 1, 0.001);
        ec_scene_free(s);
    }
}

/* Each vertex has its own colour, which reaches to the end of its line. */
static void test_colors(void)
{
    ec_scene *s = load(SCENE("", ",'mode':1", ",'camera':0"), 1);
    bool reds = false;
    for (uint32_t v = 0; s && v < s->vertex_count; v++) {
        const double x = (double)s->positions[3 * v] + s->center[0], y = (double)s->positions[3 * v + 1] + s->center[1];
        const float *c = s->colors + 4 * v;
        const int expected = y < 0.5 ? (x < 0.5 ? 0 : 1) : x > 0.5 ? 2 : 3;
        for (int k = 0; k < 4; k++) CHECK_NEAR(c[k], colors[4 * expected + k] / 255.0, 1e-6);
        reds = reds || expected == 0;
    }
    CHECK(reds);
    ec_scene_free(s);
}

int main(void)
{
    test_width();
    test_framed();
    test_modes();
    test_colors();
    TEST_END();
}
