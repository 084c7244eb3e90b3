/* tier: full */
/* Lamps in one plane, over a floor: a copy of a lamp in the lamp's own plane does not shade it. Expected values are form factors in closed
 * form (Lambert 1760). A shadow ray that ends behind a copy of its lamp, or starts below a copy of the floor, is lost: in flat scenes,
 * where rays are grazing, that was 20 % of them. */
#include "support/floor_case.h"

enum { SPP = 1024 };

typedef struct plane {
    double height, half; /* of the lamps: centred above the origin, from -half to half */
} plane;

static double form_factor(plane p)
{
    const double lamp[4][3] = {{-p.half, p.height, -p.half}, {p.half, p.height, -p.half}, {p.half, p.height, p.half}, {-p.half, p.height, p.half}};
    return lambert(lamp, 4, up) / PI;
}

/* down: the front faces the floor. */
static void lamp(gltf_writer *w, plane p, double lift, int material, bool down)
{
    const double side = 2 * p.half, u[3] = {side, 0, 0}, v[3] = {0, 0, side};
    gltf_quad(w, material, (double[3]){-p.half, p.height + lift, -p.half}, down ? u : v, down ? v : u);
}

static int two_sided(gltf_writer *w, double radiance)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},\"emissiveFactor\":[1,1,1],"
                                   "\"doubleSided\":true,\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0},"
                                   "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}}}", radiance);
}

static void check(gltf_writer *w, plane p, int samples, const char *name)
{
    char file[96];
    snprintf(file, sizeof file, "coplanar-%s-%g", name, p.height);
    check_point(gltf_write(w, file), NULL, 0.6 * 3 * form_factor(p), samples, SPP, 0.02);
    free(w);
}

/* Three copies of one lamp emit as much as one. */
static void check_twins(plane p)
{
    for (int sided = 1; sided <= 2; sided++) {
        gltf_writer *w = floor_scene(0.5 * p.height);
        int material = sided == 1 ? gltf_lambert(w, 0, 3) : two_sided(w, 3);
        for (int i = 0; i < 3; i++) lamp(w, p, 0, material, true);
        check(w, p, SKILLED, sided == 1 ? "twins" : "two-sided-twins");
    }
}

/* An object above the lamp that faces up, before or after the lamp in the file. It is 64 ulps of the largest coordinate away, a distance at
 * which walls must be opaque; or in the lamp's own plane, where rounding decides which of both a ray meets, and only light samples know. */
static void check_back_to_back(plane p, bool shines)
{
    for (int i = 0; i < 4; i++) {
        gltf_writer *w = floor_scene(0.5 * p.height);
        int below = gltf_lambert(w, 0, 3), above = shines ? gltf_lambert(w, 0, 50) : gltf_lambert(w, 0.5, 0);
        double gap = i / 2 ? 64 * 0x1p-22 : 0;
        if (i % 2) lamp(w, p, 0, below, true);
        lamp(w, p, gap, above, false);
        if (!(i % 2)) lamp(w, p, 0, below, true);
        char name[32];
        snprintf(name, sizeof name, "%s-%d", shines ? "back-to-back" : "plate", i);
        check(w, p, gap > 0 ? SKILLED : 1 << EC_SAMPLE_LIGHT, name);
    }
}

static void check_doubled_floor(plane p)
{
    gltf_writer *w = floor_scene(0.5 * p.height);
    gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-3, 0, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
    lamp(w, p, 0, gltf_lambert(w, 0, 3), true);
    check(w, p, SKILLED, "floor");
}

int main(void)
{
    static const plane planes[] = {{1, 1}, {0.01, 1}, {0.3, 0.1}};
    for (int i = 0; i < 3; i++) {
        check_twins(planes[i]);
        check_back_to_back(planes[i], true);
        check_back_to_back(planes[i], false);
        check_doubled_floor(planes[i]);
    }
    TEST_END();
}
