/* tier: full */
/* Every model under shared/assets/gltf that requires nothing unsupported renders: no failure, no invalid sample, finite, not black. Child
 * processes render, so that a crash is one failed check. Also checks the peak memory of one model. */
#define _GNU_SOURCE /* nftw, wait4, MAP_ANONYMOUS */
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "support/light.h"
#include "support/models.h"
#include "support/render_case.h"
#include "gltf/reader.h"

enum { SIZE = 32 };

enum { NONE, RENDERED, UNSUPPORTED, EMPTY, BAD };

/* Runs in the child. Universal kernels: one build for all models; specialised ones where asked. */
static int render_model(const char *path, bool all_effects)
{
    ec_error err = {0};
    ec_scene *scene;
    if (ec_scene_load(path, &scene, NULL, &err) != EC_OK) {
        if (strstr(err.text, "which eclat does not support") || strstr(err.text, "eclat reads glTF 2.0")) return UNSUPPORTED;
        if (strstr(err.text, "no triangle")) return EMPTY; /* only points and lines */
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

/* Renders models [first, last) in one child. Returns the index after the last result, and skips a model that crashed. */
static int in_child(char *const *paths, int first, int last, bool all_effects, char *results, long *peak_kib)
{
    memset(results + first, NONE, (size_t)(last - first));
    pid_t child = fork(); /* before any device is opened */
    if (child == 0) {
        case_cl()->keeps_programs = true;
        for (int i = first; i < last; i++) {
            alarm(300);
            results[i] = (char)render_model(paths[i], all_effects);
        }
        _exit(0);
    }
    int status = 0;
    struct rusage usage;
    if (child > 0) wait4(child, &status, 0, &usage);
    if (peak_kib) *peak_kib = child > 0 ? usage.ru_maxrss : 0;
    int end = first;
    while (end < last && results[end] != NONE) end++;
    if (end == last) return last;
    fprintf(stderr, "%s: %s\n", paths[end], child > 0 && WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "no result");
    results[end] = BAD;
    return end + 1;
}

int main(void)
{
    static const char folder[] = SHARED("assets/gltf"), watched[] = "MetalRoughSpheresNoTextures";
    if (!case_present(folder) || !models_collect(folder)) TEST_SKIP("no %s", folder);
    char *results = mmap(NULL, MODELS_MAX, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (results == MAP_FAILED) return 1;
    int counts[BAD + 1] = {0};
    long peak;
    for (int i = 0; i < model_count;) i = in_child(models, i, model_count, true, results, NULL);
    for (int i = 0; i < model_count; i++) {
        int result = results[i];
        counts[result]++;
        CHECK_MSG(result != BAD, "%s", models[i]);
        if (result == UNSUPPORTED || result == EMPTY)
            printf("%s: %s\n", result == EMPTY ? "no triangles" : "asks for more than is supported", models[i]);
        if (result != RENDERED || !strstr(models[i], watched)) continue;
        in_child(models, i, i + 1, true, results, &peak);
        printf("%s: peak %.0f MiB\n", models[i], (double)peak / 1024);
        CHECK_MSG(results[i] == RENDERED && peak < 600 * 1000 * 1000 / 1024, "%s: peak memory %ld KiB", models[i], peak);
    }
    /* Specialised kernels for the model with most textures, and for the one whose memory is checked. */
    static const char *const specialised[] = {"DamagedHelmet/glTF-Binary/DamagedHelmet.glb",
                                              "MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb"};
    for (int i = 0; i < 2; i++) {
        char text[512], *path = text;
        snprintf(text, sizeof text, "%s/%s", folder, specialised[i]);
        if (!case_present(path)) continue;
        in_child(&path, 0, 1, false, results, &peak);
        CHECK_MSG(results[0] == RENDERED, "%s, specialised kernels", path);
        if (i == 1) CHECK_MSG(peak < 600 * 1000 * 1000 / 1024, "%s: peak memory %ld KiB", path, peak);
        printf("%s: peak %.0f MiB\n", specialised[i], (double)peak / 1024);
    }
    printf("%d rendered, %d ask for more, %d without triangles, %d bad\n", counts[RENDERED], counts[UNSUPPORTED],
           counts[EMPTY], counts[BAD]);
    TEST_END();
}
