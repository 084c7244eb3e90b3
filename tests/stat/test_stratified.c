/* tier: quick */
/* Stratified numbers stay stratified down to a texel of an environment map. With light sampling alone, 256 samples a pixel and one
 * replicate, Sobol's error is below a third of that of independent numbers. (It is 0.005; with texels picked by hashed numbers, as by an
 * alias table, it was 0.98.) */
#include "support/floor_case.h"

enum { WIDTH = 64, HEIGHT = 32, SIZE = 16, SPP = 256 };

/* Radiance 1 + cos(phi) sin(theta) above a floor of albedo 0.6: the odd part integrates to 0. */
static void set_map(ec_scene *scene)
{
    free(scene->environment.rgb);
    scene->environment.rgb = malloc(3 * WIDTH * HEIGHT * sizeof(float));
    scene->environment.width = WIDTH;
    scene->environment.height = HEIGHT;
    scene->has_environment = true;
    for (int i = 0; scene->environment.rgb && i < WIDTH * HEIGHT; i++)
        for (int k = 0; k < 3; k++)
            scene->environment.rgb[3 * i + k] =
                (float)(1 + sin(PI * (i / WIDTH + 0.5) / HEIGHT) * cos(2 * PI * ((i % WIDTH + 0.5) / WIDTH - 0.5)));
}

static double deviation(ec_scene *scene, ec_sampler_type sampler)
{
    double square = 0;
    ec_render_options o = case_options(SIZE, SIZE, SPP);
    o.max_depth = 2;
    o.sample = EC_SAMPLE_LIGHT;
    o.sampler = sampler;
    o.replicates = 1;
    case_image image = case_render(scene, &o);
    for (int i = 0; i < SIZE * SIZE; i++) square += pow(image.rgb[3 * i + 1] - 0.6, 2) / (SIZE * SIZE);
    CHECK_MSG(fabs(image.mean[1] - 0.6) < 4 * sqrt(square) / SIZE + 1e-3, "mean %.5f, expected 0.6", image.mean[1]); /* 1e-3: bilinear */
    case_free(&image);
    return sqrt(square);
}

int main(void)
{
    ec_scene *scene = case_load(gltf_write(floor_scene(0.5), "stratified"), "1,1,1");
    set_map(scene);
    double independent = deviation(scene, EC_SAMPLER_INDEPENDENT), sobol = deviation(scene, EC_SAMPLER_SOBOL);
    printf("a pixel's error: %.2e independent, %.2e Sobol, ratio %.3f\n", independent, sobol, sobol / independent);
    CHECK_MSG(sobol < independent / 3, "errors %.2e and %.2e", sobol, independent);
    ec_scene_free(scene);
    TEST_END();
}
