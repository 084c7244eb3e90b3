/* tier: quick */
/* Meshes that are kept once: which ones, their data, and that writing them out gives the same as a loader without instances. */
#include <math.h>

#include "gltf/model.h"
#include "test_scene_files.h"
#include "gltf/reader.h"

static ec_scene *end(ec_model *m)
{
    ec_error err = {0};
    ec_scene *scene;
    CHECK_OK(ec_model_scene(m, &scene, &err), err);
    if (scene) CHECK_OK(ec_scene_validate(scene, &err), err);
    return scene;
}

/* Column major; a: 3 x 3 by rows. */
static void place(ec_model *m, const double a[9], double x, double y, double z)
{
    ec_model_place(m, (double[16]){a[0], a[3], a[6], 0, a[1], a[4], a[7], 0, a[2], a[5], a[8], 0, x, y, z, 1});
}

static const double turned[9] = {0.36, -0.48, 0.8, 0.8, 0.6, 0, -0.48, 0.64, 0.6}, mirrored[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1},
                    sheared[9] = {1, 0.7, -0.2, 0, 2, 0.3, 0.1, 0, 0.5}, tiny[9] = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-4},
                    huge[9] = {1e4, 0, 0, 0, 0, 1e4, 0, -1e4, 0}, flat[9] = {1, 0, 0, 0, 0, 0, 0, 0, 1},
                    nearly_flat[9] = {1, 0, 0, 0, 1e-7, 0, 0, 0, 1};
enum { BALL = 128, PLACES = 6, FLAT = 2 + BALL };

/* A floor; a smooth ball, far from its own origin, that is flattened, nearly flattened, and in six other places. */
static ec_scene *balls(ec_instancing instancing)
{
    ec_model *m = ec_model_new();
    ec_material white = ec_material_default();
    int32_t material = ec_model_material(m, &white);
    ec_model_instancing(m, instancing);
    ec_model_quad(m, material, (double[3]){-1, -3, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    place(m, flat, 0, 0, 5);
    ec_model_sphere(m, material, (double[3]){1000, 0, 0}, 1, 2, true);
    const struct {
        const double *turn;
        double x, y, z;
    } places[1 + PLACES] = {{nearly_flat, 0, 0, 5}, {turned, 3, 1, 0}, {mirrored, 2000, 2, 0}, {sheared, -1000, 0, 0},
                            {tiny, 7, 0, 7}, {huge, 1e6, 0, 0}, {turned, -3, 0, 2}};
    for (int i = 0; i < 1 + PLACES; i++) {
        place(m, places[i].turn, places[i].x, places[i].y, places[i].z);
        ec_model_repeat(m);
    }
    return end(m);
}

/* gamma_4 of the largest sum in a corner's transform, and the rounding of the corner and of the matrix: 6 u in all, twice. */
static double tolerance(const ec_scene *s, uint32_t i)
{
    const ec_placed *p = &s->placed[i];
    double most = 0;
    for (int row = 0; row < 3; row++)
        most = fmax(most, fabs(p->place[row][3]) + fabs(p->place[row][0]) + fabs(p->place[row][1]) + fabs(p->place[row][2]));
    return 12 * 0x1p-24 * most;
}

static const float *corner(const ec_scene *s, const float *stream, uint32_t triangle, uint32_t c) { return stream + 3 * s->indices[3 * triangle + c % 3]; }

/* The first corner of a triangle may differ: neighbours that form a quad are rotated towards each other, in pairs. A ball's normals
 * identify its corners at any size. */
static void check_triangle(const ec_scene *a, const ec_scene *b, uint32_t t, double off)
{
    uint32_t turn = 0;
    double best = INFINITY;
    for (uint32_t r = 0; r < 3; r++) {
        double far = 0;
        for (int k = 0; k < 3; k++) far += fabs((double)corner(a, a->normals, t, 0)[k] - corner(b, b->normals, t, r)[k]);
        if (far < best) best = far, turn = r;
    }
    for (uint32_t c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(corner(a, a->positions, t, c)[k], corner(b, b->positions, t, c + turn)[k], off);
            /* a normal's components: rounding of it and of the matrix, three products and sums, the length */
            CHECK_NEAR(corner(a, a->normals, t, c)[k], corner(b, b->normals, t, c + turn)[k], 16 * 0x1p-24);
        }
    CHECK(a->triangle_material[t] == b->triangle_material[t]);
}

static void written_out_it_is_the_same(void)
{
    ec_error err = {0};
    ec_scene *kept = balls(EC_INSTANCING_ON), *plain = balls(EC_INSTANCING_OFF), written;
    CHECK(plain->placed_count == 0 && plain->shape_count == 0 && !plain->whole && kept->whole);
    CHECK(kept->placed_count == PLACES && kept->shape_count == 1 && kept->shapes[0].count == BALL);
    /* flattened it has no thickness, but most triangles keep an area: these are written out, as nearly flat ones are */
    uint32_t alone = ec_scene_flat_count(kept);
    CHECK(alone > FLAT && alone < 2 + 2 * BALL && kept->triangle_count == alone + BALL && kept->shapes[0].first == alone);
    CHECK(ec_scene_met_count(kept) == plain->triangle_count && plain->triangle_count == alone + PLACES * BALL);
    CHECK(kept->dropped_degenerate == plain->dropped_degenerate);
    for (uint32_t i = 0; i < PLACES; i++) CHECK(kept->placed[i].id == alone + i * BALL && kept->placed[i].mirrored == (i == 1));
    CHECK_OK(ec_scene_write_out(kept, &written, &err), err);
    CHECK(written.triangle_count == plain->triangle_count && !written.placed_count && written.whole);
    for (int k = 0; k < 3; k++) CHECK(kept->center[k] == plain->center[k]);
    for (uint32_t t = 0; t < written.triangle_count; t++) {
        check_triangle(&written, plain, t, t < alone ? 0 : tolerance(kept, (t - alone) / BALL));
        for (uint32_t c = 0; c < 9; c++) {
            double x = written.positions[3 * written.indices[3 * t + c / 3] + c % 3];
            CHECK(x >= kept->bounds_min[c % 3] && x <= kept->bounds_max[c % 3]);
        }
    }
    ec_scene_written_free(&written);
    ec_scene_free(kept);
    ec_scene_free(plain);
}

/* Emitting triangles are lights, sampled in world space; overlaps of bodies are found there too. Leaves, which bound no body, are kept. */
static void lamps_and_bodies_are_not_kept(void)
{
    const ec_material glow = ec_material_lambert(0.5, 2);
    ec_material glass = ec_material_default(), wax = glass, leaf;
    glass.transmission = wax.diffuse_transmission = 1;
    leaf = wax;
    wax.volume = true;
    const ec_material *const of[4] = {&glow, &glass, &wax, &leaf};
    for (int i = 0; i < 4; i++) {
        ec_model *m = ec_model_new();
        ec_model_instancing(m, EC_INSTANCING_ON);
        ec_model_sphere(m, ec_model_material(m, of[i]), (double[3]){0, 0, 0}, 1, 1, true);
        place(m, turned, 5, 0, 0);
        ec_model_repeat(m);
        ec_scene *s = end(m);
        CHECK(s && s->placed_count == (i < 3 ? 0 : 2) && s->triangle_count == (i < 3 ? 64 : 32));
        ec_scene_free(s);
    }
}

/* Triangles without area, and NaN, counted once for each copy. */
static void what_is_dropped_is_counted_everywhere(void)
{
    static const float positions[36] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0, NAN, 0, 0, 0, 1, 0, 5, 5, 5, 5, 5, 5, 5, 5, 5};
    ec_scene *s[2];
    for (int i = 0; i < 2; i++) {
        ec_model *m = ec_model_new();
        ec_material white = ec_material_default();
        ec_model_instancing(m, i ? EC_INSTANCING_ON : EC_INSTANCING_OFF);
        ec_model_add(m, ec_model_material(m, &white), &(ec_model_mesh){.vertex_count = 12, .positions = positions});
        for (int k = 0; k < 2; k++) {
            place(m, turned, k + 1, 0, 0);
            ec_model_repeat(m);
        }
        s[i] = end(m);
    }
    CHECK(s[0]->dropped_degenerate == 6 && s[0]->dropped_nonfinite == 3 && s[0]->triangle_count == 3);
    CHECK(s[1]->dropped_degenerate == 6 && s[1]->dropped_nonfinite == 3 && s[1]->triangle_count == 1 && s[1]->placed_count == 3);
    ec_scene_free(s[0]);
    ec_scene_free(s[1]);
}

/* By default, meshes are kept once from a million saved triangles on. 2^15 triangles a ball: 32 places save 31 x 2^15, 33 places 2^20. */
static void auto_waits_until_it_pays(void)
{
    for (int places = 32; places <= 33; places++) {
        ec_model *m = ec_model_new();
        ec_material white = ec_material_default();
        ec_model_sphere(m, ec_model_material(m, &white), (double[3]){0, 0, 0}, 1, 6, false);
        for (int i = 1; i < places; i++) {
            place(m, turned, 3.0 * i, 0, 0);
            ec_model_repeat(m);
        }
        ec_scene *s = end(m);
        CHECK(s && s->placed_count == (places == 33 ? 33u : 0u) && s->triangle_count == (places == 33 ? 32768u : 32u * 32768u));
        ec_scene_free(s);
    }
}

/* Places are the products of all nodes above. */
static void groups_in_groups(void)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const char *text = "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'children':[1,2],'translation':[10,0,0]},"
        "{'children':[3],'scale':[2,2,2]},{'children':[4],'scale':[1,1,-1]},{'mesh':0,'translation':[0,1,0]},{'mesh':0,'translation':[0,0,3]}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'buffers':[{'byteLength':36,'uri':'@pos@'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36}],'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]}";
    char *quoted = from_single_quotes(text), *uri = data_uri(corners, sizeof corners), *whole = replace(quoted, "@pos@", uri);
    const char *path = temp_path(".gltf");
    ec_error err = {0};
    ec_scene *s;
    write_file(path, whole, strlen(whole));
    CHECK_OK(ec_scene_load_choice(path, &(ec_scene_choice){.instancing = EC_INSTANCING_ON}, &s, NULL, &err), err);
    remove(path);
    CHECK(s && s->placed_count == 2 && s->triangle_count == 1);
    const float local[3] = {-0.5f, 0.5f, 0}; /* the third corner, from the centre of the mesh */
    const double expected[2][3] = {{10, 4, 0}, {10, 1, -3}};
    for (int i = 0; s && i < 2; i++) {
        float at[3];
        ec_placed_point(&s->placed[i], local, at);
        for (int k = 0; k < 3; k++) CHECK_NEAR(at[k] + s->center[k], expected[i][k], 1e-6);
        CHECK(s->placed[i].mirrored == (i == 1));
    }
    ec_scene_free(s);
    free(quoted);
    free(uri);
    free(whole);
}

int main(void)
{
    written_out_it_is_the_same();
    lamps_and_bodies_are_not_kept();
    what_is_dropped_is_counted_everywhere();
    auto_waits_until_it_pays();
    groups_in_groups();
    TEST_END();
}
