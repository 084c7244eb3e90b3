/* tier: full */
/* A lamp with one bright texel equals a small lamp: picture and noise are those of a square of the texel's size. With nearest-texel lookup
 * both differ only by rounding. One of 4 096 uniform samples of the lamp would hit the texel: noise 110 times as large. */
#include "support/render_case.h"
#include "support/texel_lamp.h"

static case_image render(bool textured, ec_sample sample, uint64_t seed)
{
    const double texel = 1.0 / TEXEL_SIDE, at[3] = {-0.5 + TEXEL_X * texel, 1, -0.5 + TEXEL_Y * texel};
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.7, 0), (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
    gltf_quad(w, gltf_lambert(w, 0.7, 0), (double[3]){-2, 0, -0.7}, (double[3]){4, 0, 0}, (double[3]){0, 2, 0}); /* beside the lamp */
    gltf_add(&w->samplers, "{\"magFilter\":9728}");
    gltf_quad(w, gltf_lambert(w, 0, 0), (double[3]){-0.5, 1.0001, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1}); /* shadows the rest */
    if (textured) texel_lamp_add(w, "stat-parts", 0, 0, 255, 100);
    else gltf_quad(w, gltf_lambert(w, 0, 100), at, (double[3]){texel, 0, 0}, (double[3]){0, 0, texel});
    gltf_camera(w, (double[3]){0, 1.5, 2.5}, (double[3]){0, 0.4, -0.5}, 0.9);
    ec_scene *scene = case_load(gltf_write(w, textured ? "stat-parts" : "stat-square"), NULL);
    free(w);
    ec_render_options o = case_random(16, 2048, sample, seed);
    o.max_depth = 3;
    o.lanes = 4;
    case_image image = case_render(scene, &o);
    ec_scene_free(scene);
    return image;
}

static void compare(ec_sample sample, const char *name)
{
    case_image lamp = render(true, sample, 3), square = render(false, sample, 4);
    case_check_same(&lamp, &square, 1, name);
    const double noise = lamp.mean_se[1] / square.mean_se[1];
    printf("%s: %.2f times the noise of a small lamp\n", name, noise);
    CHECK_MSG(noise < 1.7, "%s: %g times the noise of a small lamp", name, noise);
    case_free(&lamp);
    case_free(&square);
}

int main(void)
{
    compare(EC_SAMPLE_MIS, "both ways");
    compare(EC_SAMPLE_LIGHT, "light sampling");
    TEST_END();
}
