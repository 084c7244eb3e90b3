/* Every model under shared/assets/gltf that asks for nothing unsupported renders: no failure, no invalid sample, finite, not
 * black. Each in a child process, so that a crash is one failed check, with its peak memory. (ctest label: slow) */
#define _XOPEN_SOURCE 700 /* nftw */
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "support/light.h"
#include "support/models.h"
#include "support/render_case.h"

enum { SIZE = 32 };

enum { RENDERED, UNSUPPORTED, EMPTY, BAD };

/* In the child. Universal kernels: one build for all models; specialised ones where asked. */
static int render_model(const char *path, bool all_effects)
{
    ec_error err = {0};
    ec_scene *scene;
    if (ec_scene_load(path, &scene, NULL, &err) != EC_OK) {
        if (strstr(err.text, "which eclat does not support") || strstr(err.text, "eclat reads glTF 2.0")) return UNSUPPORTED;
        if (strstr(err.text, "no triangle")) return EMPTY; /* points and lines only */
        fprintf(stderr, "%s\n", err.text);
        return BAD;
    }
    if (!has_light(scene) && ec_scene_set_environment(scene, "1,1,1", NULL, &err) != EC_OK) return BAD;
    ec_render_options o = case_options(SIZE, SIZE, 4);
    o.camera = scene->default_camera;
    if (all_effects) o = case_with_all_effects(o);
    case_image image;
    if (case_try(scene, &o, &image, &err) != EC_OK) {
        fprintf(stderr, "%s\n", err.text);
        return BAD;
    }
    if (image.stats.invalid_samples) fprintf(stderr, "%llu invalid samples\n", (unsigned long long)image.stats.invalid_samples);
    double sum = image.mean[0] + image.mean[1] + image.mean[2];
    return image.stats.invalid_samples == 0 && isfinite(sum) && sum > 0 ? RENDERED : BAD;
}

/* The device must not be open before a fork. */
static int in_child(const char *path, bool all_effects, long *peak_kib)
{
    pid_t child = fork();
    if (child < 0) return BAD;
    if (child == 0) {
        alarm(300);
        _exit(render_model(path, all_effects));
    }
    int status = 0;
    struct rusage usage;
    wait4(child, &status, 0, &usage);
    *peak_kib = usage.ru_maxrss;
    if (WIFSIGNALED(status)) fprintf(stderr, "%s: %s\n", path, strsignal(WTERMSIG(status)));
    return WIFEXITED(status) ? WEXITSTATUS(status) : BAD;
}

int main(void)
{
    static const char folder[] = SHARED("assets/gltf");
    if (!case_present(folder) || !models_collect(folder)) TEST_SKIP("no %s", folder);
    int counts[BAD + 1] = {0};
    long peak;
    for (int i = 0; i < model_count; i++) {
        int result = in_child(models[i], true, &peak);
        counts[result]++;
        CHECK_MSG(result != BAD, "%s", models[i]);
        if (result == UNSUPPORTED || result == EMPTY)
            printf("%s: %s\n", result == EMPTY ? "no triangles" : "asks for more than is supported", models[i]);
        if (result != RENDERED || !strstr(models[i], "MetalRoughSpheresNoTextures")) continue;
        printf("%s: peak %.0f MiB\n", models[i], (double)peak / 1024);
        CHECK_MSG(peak < 600 * 1000 * 1000 / 1024, "%s: peak memory %ld KiB", models[i], peak);
    }
    /* Specialised kernels on the models with most textures. */
    static const char *const specialised[] = {"DamagedHelmet/glTF-Binary/DamagedHelmet.glb",
                                              "AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb",
                                              "TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb",
                                              "MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb"};
    for (int i = 0; i < 4; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", folder, specialised[i]);
        if (!case_present(path)) continue;
        CHECK_MSG(in_child(path, false, &peak) == RENDERED, "%s, specialised kernels", path);
        if (i == 3) CHECK_MSG(peak < 600 * 1000 * 1000 / 1024, "%s: peak memory %ld KiB", path, peak);
        printf("%s: peak %.0f MiB\n", specialised[i], (double)peak / 1024);
    }
    printf("%d rendered, %d ask for more, %d without triangles, %d bad\n", counts[RENDERED], counts[UNSUPPORTED],
           counts[EMPTY], counts[BAD]);
    TEST_END();
}
