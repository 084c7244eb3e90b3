/* tier: quick */
/* Light samples are divided between an environment and a lamp. The picture is the same for any share. Where one of the lights hardly
 * reaches anything in view, the chosen share has less noise than halves. */
#include "device/light_share.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

/* A floor and a block under an environment of 1; a lamp of 1 x 1 below the floor or, if `over`, above it. */
static ec_scene *load_floor(bool over)
{
    gltf_writer *w = gltf_new();
    const int white = gltf_lambert(w, 0.7, 0), lamp = gltf_lambert(w, 0, 40);
    const double y = over ? 2.5 : -2.5;
    gltf_quad(w, white, (double[3]){-4, 0, 4}, (double[3]){8, 0, 0}, (double[3]){0, 0, -8});
    gltf_quad(w, white, (double[3]){0.2, 0.4, 0.6}, (double[3]){0.5, 0, 0}, (double[3]){0, 0, -0.5});
    gltf_quad(w, white, (double[3]){0.2, 0, 0.6}, (double[3]){0.5, 0, 0}, (double[3]){0, 0.4, 0});
    gltf_quad(w, lamp, (double[3]){-0.5, y, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1}); /* shines downwards */
    gltf_camera(w, (double[3]){0, 2, 3}, (double[3]){0, 0.2, 0}, 0.8);
    ec_scene *scene = case_load(gltf_write(w, over ? "share-over" : "share-under"), "1,1,1");
    free(w);
    return scene;
}

static case_image render(const ec_scene *scene, ec_sample sample, double share, uint32_t spp, uint64_t seed)
{
    ec_render_options o = case_random(16, spp, sample, seed);
    o.far_share = share;
    return case_render(scene, &o);
}

static void shares_agree(void)
{
    static const double shares[] = {0.125, 0.5, 0.875};
    ec_scene *scene = load_floor(true);
    case_image other = render(scene, EC_SAMPLE_BSDF, 0, 4096, 21);
    for (uint64_t i = 0; i < 3; i++) {
        char what[64];
        case_image image = render(scene, EC_SAMPLE_MIS, shares[i], 2048, i + 1), light = render(scene, EC_SAMPLE_LIGHT, shares[i], 2048, i + 11);
        snprintf(what, sizeof what, "a share of %g, and BSDF sampling", shares[i]);
        case_check_same(&image, &other, 2, what);
        snprintf(what, sizeof what, "light sampling with a share of %g, and BSDF sampling", shares[i]);
        case_check_same(&light, &other, 2, what);
        CHECK(image.stats.far_share == shares[i]);
        case_free(&image);
        case_free(&light);
    }
    case_free(&other);
    ec_scene_free(scene);
}

static void noise_is_less(void)
{
    ec_scene *scene = load_floor(false);
    case_image halves = render(scene, EC_SAMPLE_LIGHT, 0.5, 64, 3), chosen = render(scene, EC_SAMPLE_LIGHT, 0, 64, 3);
    const double less = chosen.stats.film.error / halves.stats.film.error;
    printf("environment's share %g: error %.4f, with halves %.4f\n", chosen.stats.far_share, chosen.stats.film.error, halves.stats.film.error);
    CHECK(chosen.stats.far_share == 0.875);
    CHECK_MSG(less < 0.85, "the error is %.2f times that with halves", less); /* sqrt(4 / 7) = 0.76 for independent samples */
    case_free(&halves);
    case_free(&chosen);
    ec_scene_free(scene);
}

int main(void)
{
    shares_agree();
    noise_is_less();
    TEST_END();
}
