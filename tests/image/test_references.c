/* tier: full */
/* Pictures of other renderers, and one scene in several forms.
 *
 * Bitterli's Cornell box (Tungsten) and Veach's plates have no standard errors, so they are compared in blocks with little noise. Ours
 * agree to a few parts in a thousand (Cornell) and a few per cent (plates). The plates are Beckmann there and GGX here, whose tails are
 * longer: dark blocks beside a highlight differ by as much as their value. The hard variants (assets/hard/derived) are the Cornell box
 * scaled, moved and rotated: the same picture. */
#include "support/render_case.h"

#define CORNELL SHARED("assets/classic/gltf/cornell-bitterli/cornell-bitterli-blocked.gltf")
#define DERIVED SHARED("assets/hard/derived/")

/* Mean of |a - b| over blocks, relative to the mean of b; its maximum; and the difference of the means. */
typedef struct block_difference {
    double mean, worst, bias;
} block_difference;

static block_difference compare_blocks(const ztest_picture *a, const ztest_picture *b, double brightest)
{
    block_difference d = {0};
    double sum = 0, difference = 0, whole = 0, values = 0;
    for (size_t i = 0; i < 3 * (size_t)a->width * a->height; i++) whole += b->rgb[i];
    whole /= 3.0 * a->width * a->height;
    for (size_t i = 0; i < 3 * (size_t)a->width * a->height; i++) {
        if (b->rgb[i] > brightest) continue; /* the lamp and its edge */
        double e = (double)a->rgb[i] - b->rgb[i];
        sum += b->rgb[i];
        difference += e;
        d.mean += fabs(e);
        d.worst = fmax(d.worst, fabs(e) / (b->rgb[i] + 0.1 * whole));
        values++;
    }
    d.mean /= sum;
    d.bias = difference / sum;
    printf("%.0f of %u values compared\n", values, 3 * a->width * a->height);
    return d;
}

static void against_picture(const char *name, const char *scene_path, const char *picture_path, uint32_t width, uint32_t height,
                            uint32_t shrink, uint32_t block, uint32_t spp, double brightest, block_difference allowed)
{
    if (!case_present(scene_path) || !case_present(picture_path)) {
        printf("not there: %s\n", picture_path);
        return;
    }
    ec_error err = {0};
    ztest_picture full = {0};
    CHECK_OK(ztest_load(picture_path, INFINITY, &full, &err), err);
    if (!full.rgb) return;
    ec_render_options o = case_options(width, height, spp);
    o.seed = 3; /* a strategy with few fireflies on the plates */
    case_image image = case_render_file(scene_path, NULL, &o);
    ztest_picture ours = case_picture(&image), a = case_blocks(&ours, block), b = case_blocks(&full, shrink * block);
    CHECK(a.width == b.width && a.height == b.height);
    block_difference d = compare_blocks(&a, &b, brightest);
    printf("%s: blocks differ by %.3f %% on average, %.2f %% at worst; means by %+.3f %%\n", name, 100 * d.mean, 100 * d.worst,
           100 * d.bias);
    CHECK_MSG(d.mean < allowed.mean, "%s: blocks differ by %.3f %% on average", name, 100 * d.mean);
    CHECK_MSG(d.worst < allowed.worst, "%s: a block differs by %.2f %%", name, 100 * d.worst);
    CHECK_MSG(fabs(d.bias) < allowed.bias, "%s: means differ by %.3f %%", name, 100 * d.bias);
    ztest_free(&a);
    ztest_free(&b);
    ztest_free(&full);
    case_free(&image);
}

static void hard_variants(void)
{
    static const char *const files[] = {"cornell-baked-offset-1e3.gltf", "cornell-baked-rotated.gltf",
                                        "cornell-node-scale-1e-4.gltf", "cornell-node-scale-1e4.gltf"};
    if (!case_present(CORNELL)) return;
    ec_render_options o = case_options(64, 64, 1024);
    o.max_depth = 8;
    case_image plain = case_render_file(CORNELL, NULL, &o);
    for (int i = 0; i < 4; i++) {
        char path[512];
        snprintf(path, sizeof path, DERIVED "%s", files[i]);
        if (!case_present(path)) continue;
        o.seed = (uint64_t)i + 1;
        case_image image = case_render_file(path, NULL, &o);
        case_check_same(&image, &plain, 1, files[i]);
        case_free(&image);
    }
    case_free(&plain);
}

/* No NaN, the same picture twice and from both BVHs. */
static void degenerate(const char *file)
{
    char path[512];
    snprintf(path, sizeof path, SHARED("assets/hard/") "%s", file);
    if (!case_present(path)) return;
    ec_scene *scene = case_load(path, NULL);
    ec_render_options o = case_options(64, 64, 16);
    case_image first;
    static const char *const accels[] = {"bvh8", "bvh2", "bvh8"};
    for (int i = 0; i < 3; i++) {
        o.accel = accels[i];
        case_image image = case_render(scene, &o);
        if (i == 0) {
            first = image;
            CHECK_MSG(image.mean[1] > 0 && isfinite(image.mean[0] + image.mean[1] + image.mean[2]), "%s: %g", file, image.mean[1]);
            printf("%-44s mean %.5f, %u triangles, %u degenerate\n", file, image.mean[1], scene->triangle_count,
                   scene->dropped_degenerate);
            continue;
        }
        CHECK_MSG(!memcmp(first.rgb, image.rgb, 3 * 64 * 64 * sizeof(float)), "%s: render %d has other bits", file, i);
        case_free(&image);
    }
    case_free(&first);
    ec_scene_free(scene);
}

int main(void)
{
    if (!case_present(CORNELL)) TEST_SKIP("no %s", CORNELL);
    /* 1024 x 1024 reduced to 256 x 256, then blocks of 16 x 16; the lamp (17, 12, 4) is clipped. */
    against_picture("cornell-bitterli", CORNELL, SHARED("assets/classic/bitterli/cornell-box/TungstenRender.exr"), 256, 256, 4, 16,
                    128, 2, (block_difference){.mean = 0.01, .worst = 0.06, .bias = 0.005});
    against_picture("veach-mis", SHARED("assets/classic/gltf/veach-mis/veach-mis.gltf"),
                    SHARED("assets/classic/bitterli/veach-mis/TungstenRender.exr"), 320, 180, 4, 20, 128, 1e30,
                    (block_difference){.mean = 0.06, .worst = 1.4, .bias = 0.04});
    hard_variants();
    degenerate("derived/coplanar-quads.gltf");
    degenerate("derived/degenerate-triangles.gltf");
    degenerate("derived/teapot-in-stadium.gltf");
    degenerate("glb-converted/manifold_Offset1.obj.glb");
    degenerate("glb-converted/trimesh_wallhole.obj.glb");
    degenerate("glb-converted/manifold_openscad-nonmanifold-crash.obj.glb");
    degenerate("glb-converted/thingi10k_79741.stl.glb");
    TEST_END();
}
