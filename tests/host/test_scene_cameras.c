/* tier: quick */
/* Cameras, punctual lights, the environment. */
#include "image/image.h"
#include "support/light.h"
#include "test_scene_files.h"

#define CAMERAS                                                                                                        \
    "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_lights_punctual'],'scene':0,'scenes':[{'nodes':[0,1,2,3,4,5]}],"   \
    "'nodes':[{'mesh':0},{'camera':0,'name':'node-name','translation':[1,2,3],"                                        \
    "'rotation':[0,0.70710678,0,0.70710678],'scale':[2,-3,4]},"                                                        \
    "{'camera':1,'matrix':[1,0,0,0, 0,0,-1,0, 0,1,0,0, 0,5,0,1]},"                                                     \
    "{'extensions':{'KHR_lights_punctual':{'light':0}},'translation':[0,4,0],'rotation':[-0.70710678,0,0,0.70710678]},"   \
    "{'extensions':{'KHR_lights_punctual':{'light':1}}},{'extensions':{'KHR_lights_punctual':{'light':2}}}],"          \
    "'cameras':[{'type':'perspective','perspective':{'yfov':0.5,'aspectRatio':1.5,'znear':0.1}},"                      \
    "{'type':'orthographic','name':'flat','orthographic':{'xmag':2,'ymag':-3,'znear':0,'zfar':9}}],"                   \
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','color':[1,0.5,0],'intensity':10,'range':7,"        \
    "'spot':{'innerConeAngle':0.2,'outerConeAngle':0.4}},{'type':'point'},{'type':'directional','intensity':3}]}},"    \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"                                                       \
    "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"                        \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]}"

static void check_vector(const float *v, double x, double y, double z)
{
    CHECK_NEAR(v[0], x, 1e-6);
    CHECK_NEAR(v[1], y, 1e-6);
    CHECK_NEAR(v[2], z, 1e-6);
}

static void check_lights(const ec_scene *s)
{
    CHECK(s->light_count == 3);
    const ec_light *spot = s->lights, *point = s->lights + 1, *sun = s->lights + 2;
    CHECK(spot->type == EC_LIGHT_SPOT && point->type == EC_LIGHT_POINT && sun->type == EC_LIGHT_DIRECTIONAL);
    check_vector(spot->position, -0.5, 3.5, 0);
    check_vector(spot->direction, 0, -1, 0);
    check_vector(spot->intensity, 10, 5, 0);
    CHECK_NEAR(spot->range, 7, 0);
    CHECK_NEAR(spot->cos_inner, cos(0.2), 1e-6);
    CHECK_NEAR(spot->cos_outer, cos(0.4), 1e-6);
    check_vector(point->intensity, 1, 1, 1);
    CHECK_NEAR(point->range, 0, 0);
    check_vector(sun->direction, 0, 0, -1);
    check_vector(sun->intensity, 3, 3, 3);
    CHECK(has_light(s));
}

static void test_cameras_and_lights(void)
{
    ec_error err;
    ec_scene *s = load_text(CAMERAS, triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK(s->camera_count == 2 && s->default_camera == 0);
    const ec_camera *c = s->cameras;
    CHECK(c[0].type == EC_CAMERA_PERSPECTIVE && c[0].yfov == 0.5f && c[0].aspect == 1.5f);
    check_vector(c[0].position, 0.5, 1.5, 3);
    check_vector(c[0].forward, -1, 0, 0);
    check_vector(c[0].up, 0, -1, 0); /* mirrored in y: upside down, but not left-right */
    check_vector(c[0].right, 0, 0, 1);
    CHECK(c[1].type == EC_CAMERA_ORTHOGRAPHIC && c[1].xmag == 2 && c[1].ymag == 3);
    check_vector(c[1].forward, 0, -1, 0);
    check_vector(c[1].up, 0, 0, -1);
    check_vector(c[1].right, 1, 0, 0);
    uint32_t found = 9;
    CHECK_OK(ec_scene_find_camera(s, "flat", &found, &err), err);
    CHECK(found == 1);
    CHECK_OK(ec_scene_find_camera(s, "node-name", &found, &err), err);
    CHECK(found == 0);
    CHECK_OK(ec_scene_find_camera(s, "1", &found, &err), err);
    CHECK(found == 1);
    const char *wrong[] = {"2", "-1", "1x", "", "front", "99999999999999999999999"};
    for (int i = 0; i < 6; i++) {
        CHECK_MSG(ec_scene_find_camera(s, wrong[i], &found, &err) == EC_FAILED, "\"%s\" found", wrong[i]);
        CHECK_MSG(strstr(err.text, "0 \"node-name\", 1 \"flat\"") != NULL, "%s", err.text);
    }
    check_lights(s);
    ec_scene_free(s);
}

/* The framing camera's square view must contain every corner of the bounds. */
static void test_framing(void)
{
    ec_error err;
    ec_scene *s = load_text(TRIANGLE(",'scale':[100,1,1],'translation':[7,7,7]", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK_MSG(strstr(messages, "N ") && strstr(messages, "frames all of it"), "%s", messages);
    const ec_camera *c = s->cameras;
    for (int corner = 0; corner < 8; corner++) {
        double x = 0, y = 0, z = 0;
        for (int i = 0; i < 3; i++) {
            double d = (double)(corner >> i & 1 ? s->bounds_max[i] : s->bounds_min[i]) - c->position[i];
            x += d * c->right[i];
            y += d * c->up[i];
            z += d * c->forward[i];
        }
        double edge = z * tan(0.5 * c->yfov);
        CHECK_MSG(z > 0 && fabs(x) <= edge && fabs(y) <= edge, "corner %d: %g %g %g", corner, x, y, z);
    }
    ec_scene_free(s);
}

static void test_bad_cameras(void)
{
    static const char *const bad[][3] = {{"'yfov':0.5", "'yfov':0", "yfov must be positive"}, {"'yfov':0.5", "'yfov':-1", "yfov"},
                                         {"'yfov':0.5,", "", "cameras[0].perspective.yfov is missing"},
                                         {",'perspective':{'yfov':0.5,'aspectRatio':1.5,'znear':0.1}", "", "cameras[0].perspective is missing"},
                                         {"'type':'orthographic'", "'type':'perspective'", "cameras[1].perspective is missing"},
                                         {",'orthographic':{'xmag':2,'ymag':-3,'znear':0,'zfar':9}", "", "cameras[1].orthographic is missing"},
                                         {"'xmag':2", "'xmag':0", "must not be zero"},
                                         {"'light':1", "'light':3", "light is 3 but the file has 3 lights"},
                                         {"'type':'point'", "'type':'area'", "lights[1].type is area"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char *text = replace(CAMERAS, bad[i][0], bad[i][1]);
        expect_failure(text, triangle_blobs, bad[i][2]);
        free(text);
    }
}

/* Values that are changed on loading. */
static void test_odd_values_of_lights(void)
{
    static const char *const odd[][3] = {
        {"{'type':'point'}", "{'type':'point','intensity':-1}", "light 1 has values out of KHR_lights_punctual's range"},
        {"{'type':'point'}", "{'type':'point','range':-1}", "light 1 has values out of"},
        {"{'type':'point'}", "{'type':'point','intensity':1e35}", "light 1 has values out of"},
        {"{'type':'point'}", "{'type':'point','range':0}", "light 1 has range 0, which KHR_lights_punctual does not allow; it is taken as infinite"}};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        char *text = replace(CAMERAS, odd[i][0], odd[i][1]);
        ec_error err;
        ec_scene *s = load_text(text, triangle_blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        CHECK_MSG(strstr(messages, "W ") && strstr(messages, odd[i][2]), "%s: %s", odd[i][1], messages);
        ec_scene_free(s);
        free(text);
    }
}

static void test_environment(void)
{
    ec_scene s = {0};
    ec_error err;
    CHECK(!has_light(&s));
    CHECK_OK(ec_scene_set_environment(&s, "1,0.5, 2e-1", NULL, &err), err);
    CHECK(s.has_environment && !s.environment.rgb && s.environment.constant[1] == 0.5f && has_light(&s));
    CHECK_NEAR(s.environment.constant[2], 0.2, 1e-7);
    const char *wrong[] = {"1,2", "1,2,3,4", "1,,2", "-1,1,1", "1,1,1e99", ","};
    for (int i = 0; i < 6; i++) {
        CHECK_MSG(ec_scene_set_environment(&s, wrong[i], NULL, &err) == EC_FAILED, "\"%s\" accepted", wrong[i]);
        CHECK(s.environment.constant[0] == 1); /* untouched */
    }
    CHECK(ec_scene_set_environment(&s, "/no/such/file.hdr", NULL, &err) == EC_FAILED && err.text[0]);
}

/* A picture with NaN, infinite and negative values is cleaned, and a message counts them. */
static void test_environment_picture(void)
{
    const float rgb[6] = {1, NAN, 3, -4, 5, INFINITY};
    const ec_channel channels[3] = {{"R", rgb, 3}, {"G", rgb + 1, 3}, {"B", rgb + 2, 3}};
    const char *path = ECLAT_TEST_OUT "/scene_environment.exr";
    ec_scene *s = calloc(1, sizeof *s);
    ec_error err;
    ec_log log = {keep_message, NULL};
    CHECK_OK(ec_exr_write(path, 2, 1, channels, 3, NULL, 0, &err), err);
    messages[0] = 0;
    CHECK_OK(ec_scene_set_environment(s, "1,1,1", &log, &err), err);
    CHECK_OK(ec_scene_set_environment(s, path, &log, &err), err);
    CHECK_MSG(strstr(messages, "3 values are NaN, infinite or negative") != NULL, "%s", messages);
    CHECK(s->has_environment && s->environment.width == 2 && s->environment.height == 1 && s->environment.constant[0] == 0);
    const float expected[6] = {1, 0, 3, 0, 5, 0};
    for (int i = 0; s->environment.rgb && i < 6; i++) CHECK_NEAR(s->environment.rgb[i], expected[i], 0);
    ec_scene_free(s);
    remove(path);
}

/* Values outside KHR_lights_punctual's ranges are clamped, with a message. */
static void test_odd_lights(void)
{
    static const struct {
        const char *good, *odd;
        bool told;
    } cases[] = {
        {"'intensity':10", "'intensity':-10", true},      {"[1,0.5,0]", "[1,-0.5,0]", true}, {"[1,0.5,0]", "[1,0.5,2]", false},
        {"'range':7", "'range':-7", true},                {"'range':7", "'range':0", false}, {"'outerConeAngle':0.4", "'outerConeAngle':1.6", true},
        {"'innerConeAngle':0.2", "'innerConeAngle':0.5", true}, {"'innerConeAngle':0.2", "'innerConeAngle':0.4", false},
        {"'innerConeAngle':0.2", "'innerConeAngle':-1", true},  {"'outerConeAngle':0.4", "'outerConeAngle':1.5707964", false},
        {"'type':'point'", "'type':'point','spot':{'innerConeAngle':3}", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(CAMERAS, cases[i].good, cases[i].odd);
        ec_error err;
        ec_scene *s = load_text(json, triangle_blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        CHECK_MSG((strstr(messages, "light 0 has values out of") != NULL) == cases[i].told, "%s: %s", cases[i].odd, messages);
        ec_scene_free(s);
        free(json);
    }
}

int main(void)
{
    test_cameras_and_lights();
    test_odd_values_of_lights();
    test_environment_picture();
    test_framing();
    test_bad_cameras();
    test_odd_lights();
    test_environment();
    TEST_END();
}
