/* tiers: quick, full */
/* Live sessions without a window, by the public functions alone: pictures of views, probes, saves that their commands repeat, files that change. */
#include <eclat/eclat.h>

#include <math.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

#include "support/test.h"

#define SCENE ECLAT_SOURCE_DIR "/scenes/cornell-box/cornell-box.gltf"
#define OUT ECLAT_TEST_OUT "/live-"

/* Messages of the session itself. */
typedef struct told {
    sem_t news;
    atomic_int saves;
    char command[4096];
} told;

static void wake(void *user) { sem_post(&((told *)user)->news); }

static void keep_command(void *user, const char *command)
{
    told *t = user;
    snprintf(t->command, sizeof t->command, "%s", command);
    atomic_fetch_add(&t->saves, 1);
}

static eclat_job *make_job(const char *scene, const char *output)
{
    eclat_error err;
    eclat_job *job = NULL;
    CHECK_MSG(eclat_job_new("render", &job, &err) == ECLAT_OK, "%s", err.text);
    CHECK_MSG(eclat_job_add(job, scene, &err) == ECLAT_OK, "%s", err.text);
    CHECK_MSG(eclat_job_set(job, "spp", "4", &err) == ECLAT_OK, "%s", err.text);
    CHECK_MSG(eclat_job_set(job, "output", output, &err) == ECLAT_OK, "%s", err.text);
    return job;
}

/* Opens a session for the job; the session outlives the job. */
static eclat_live *open_live(eclat_job *job, const char *against, told *t)
{
    eclat_error err;
    eclat_live *live = NULL;
    const eclat_live_listener listener = {t, wake, keep_command};
    *t = (told){.saves = 0};
    sem_init(&t->news, 0, 0);
    CHECK_MSG(eclat_live_open(job, against, &listener, &live, &err) == ECLAT_OK, "%s", err.text);
    eclat_job_free(job);
    if (!live) exit(1);
    return live;
}

static eclat_status wait_for(eclat_live *live, told *t, bool (*what)(const eclat_status *status, uint32_t number), uint32_t number)
{
    eclat_status status;
    for (eclat_live_status(live, &status); !what(&status, number); eclat_live_status(live, &status)) sem_wait(&t->news);
    return status;
}

static bool is_settled(const eclat_status *s, uint32_t number) { return (void)number, s->is_settled || s->has_failed; }
static bool is_saved(const eclat_status *s, uint32_t number) { return s->saves == number; }
static bool is_picked(const eclat_status *s, uint32_t number) { return s->picks == number; }

static eclat_view_request small_view(eclat_live *live)
{
    eclat_view_request view = eclat_live_view(live);
    view.width = 24;
    view.height = 16;
    return view;
}

static eclat_status settle(eclat_live *live, told *t, eclat_view_request *view)
{
    eclat_live_set_view(live, view);
    return wait_for(live, t, is_settled, 0);
}

/* Mean brightness of the latest picture; -1: there is no new one. */
static double brightness(eclat_live *live, eclat_shown which)
{
    eclat_image image;
    double sum = 0;
    if (!eclat_live_take(live, which, &image)) return -1;
    CHECK(image.width == 24 && image.height == 16);
    for (uint32_t i = 0; i < 3 * image.width * image.height; i++) sum += image.rgb[i];
    return sum / (3 * image.width * image.height);
}

/* Renders a command's job. */
static eclat_picture *render_command(char *command)
{
    eclat_error err;
    eclat_job *job = NULL;
    eclat_picture *picture = NULL;
    const char *word = strtok(command, " ");
    CHECK(word && !strcmp(word, "eclat") && !strcmp(strtok(NULL, " "), "render"));
    CHECK(eclat_job_new("render", &job, NULL) == ECLAT_OK && eclat_job_add(job, strtok(NULL, " "), NULL) == ECLAT_OK);
    while ((word = strtok(NULL, " ")) && !strncmp(word, "--", 2)) {
        char *value = strchr(word, '=');
        if (value) *value++ = 0;
        CHECK_MSG(eclat_job_set(job, word + 2, value, &err) == ECLAT_OK, "%s", err.text);
    }
    CHECK_MSG(eclat_job_run(job, &picture, &err) == ECLAT_OK, "%s", err.text);
    eclat_job_free(job);
    return picture;
}

static void check_repeats(char *command, const char *saved)
{
    eclat_error err;
    eclat_comparison c = {.rmse = 1};
    eclat_picture *again = render_command(command);
    CHECK_MSG(eclat_picture_write(again, OUT "again.exr", &err) == ECLAT_OK, "%s", err.text);
    CHECK_MSG(eclat_compare(OUT "again.exr", saved, &c, &err) == ECLAT_OK, "%s", err.text);
    CHECK(c.rmse == 0 && !c.differ);
    eclat_picture_free(again);
}

static void test_a_picture_and_what_is_known_of_it(void)
{
    told t;
    eclat_live *live = open_live(make_job(SCENE, OUT "a.exr"), NULL, &t);
    eclat_view_request view = small_view(live);
    eclat_image image;
    CHECK(view.camera == -1 && !view.is_moved && view.integrator == ECLAT_PATH && view.exposure == 0);
    CHECK(!eclat_live_take(live, ECLAT_PICTURE, &image));
    view.x = 12, view.y = 15; /* the floor */
    eclat_status s = settle(live, &t, &view);
    const eclat_facts *facts = eclat_live_facts(live);
    CHECK(facts->serial == 1 && facts->camera_count == 1 && facts->height == 600 && facts->radius > 0 && !strcmp(facts->scene, SCENE) && *facts->device);
    CHECK(facts->effect_count > 0 && facts->effects[0].bit && *facts->effects[0].name && !facts->has_map);
    CHECK(s.samples == 4 && s.is_complete && !strcmp(s.stopped_by, "spp") && s.pictures > 0 && s.first_light > 0 && !s.preview && !s.has_failed);
    CHECK(s.error > 0 && isfinite(s.error) && strstr(s.effects, facts->effects[0].name));
    CHECK(s.under.x == 12 && s.under.is_inside && s.under.has_surface && s.under.has_error && s.under.rgb[0] > 0 && s.under.depth > 0);
    CHECK(s.under.node >= 0 && s.under.radius > 0 && s.picked.node == -1);
    CHECK(brightness(live, ECLAT_PICTURE) > 10 && brightness(live, ECLAT_PICTURE) == -1);
    s = wait_for(live, &t, is_picked, eclat_live_pick(live, 0, 99));
    CHECK(!s.picked.is_inside && s.picked.y == 99);
    view.more = 1;
    CHECK(settle(live, &t, &view).samples == 16);
    eclat_live_close(live);
}

static void test_views_change_it(void)
{
    told t;
    eclat_live *live = open_live(make_job(SCENE, OUT "b.exr"), NULL, &t);
    eclat_view_request view = small_view(live);
    settle(live, &t, &view);
    const double first = brightness(live, ECLAT_PICTURE);
    view.exposure = 200; /* more than the picture has */
    view.env_degrees = NAN;
    settle(live, &t, &view);
    CHECK(view.exposure == 100 && view.env_degrees == 0 && brightness(live, ECLAT_PICTURE) > first + 50);
    view.exposure = 0;
    view.integrator = ECLAT_RASTER;
    view.second = ECLAT_SECOND_SAMPLES;
    eclat_status s = settle(live, &t, &view);
    CHECK(s.integrator == ECLAT_RASTER && s.second == ECLAT_SECOND_SAMPLES && brightness(live, ECLAT_SECOND_PICTURE) > 10);
    view.second = ECLAT_SECOND_INTEGRATOR;
    view.second_integrator = ECLAT_WHITTED;
    s = settle(live, &t, &view);
    CHECK(s.second == ECLAT_SECOND_INTEGRATOR && s.second_integrator == ECLAT_WHITTED);
    view.without = eclat_live_facts(live)->effects[0].bit;
    CHECK(strstr(settle(live, &t, &view).effects, eclat_live_facts(live)->effects[0].name) == NULL);
    eclat_live_close(live);
}

/* Without a denoiser the picture stays noisy, and the status says why. cli/test_denoise puts a denoiser into the build folder. */
static void test_a_view_denoises(void)
{
    told t;
    eclat_error err;
    eclat_job *job = make_job(SCENE, OUT "d.exr");
    const char *fetched = ECLAT_TEST_OUT "/../oidn/pyoidn";
    if (access(fetched, R_OK) == 0) setenv("ECLAT_OIDN", fetched, 0);
    CHECK_MSG(eclat_job_set(job, "spp", "48", &err) == ECLAT_OK, "%s", err.text);
    eclat_live *live = open_live(job, NULL, &t);
    eclat_view_request view = small_view(live);
    eclat_status s = settle(live, &t, &view);
    CHECK(!view.is_denoised && !s.is_denoised && !*s.undenoised);
    const double noisy = brightness(live, ECLAT_PICTURE);
    view.is_denoised = 1;
    s = settle(live, &t, &view);
    CHECK(s.samples == 48 && !*s.trouble[ECLAT_TROUBLE_CAMERA]);
    CHECK_MSG(s.is_denoised ? !*s.undenoised : strstr(s.undenoised, "Open Image Denoise") != NULL, "%d, '%s'", s.is_denoised, s.undenoised);
    if (s.is_denoised) {
        CHECK(s.best.low95 <= s.best.error && s.best.error > 0 && s.best.error <= s.best.high95);
        wait_for(live, &t, is_saved, eclat_live_save(live, &view));
        CHECK_MSG(strstr(t.command, "--denoise ") != NULL, "%s", t.command);
        check_repeats(t.command, OUT "d.exr");
    }
    view.is_denoised = 0;
    s = settle(live, &t, &view);
    CHECK(!s.is_denoised && brightness(live, ECLAT_PICTURE) == noisy);
    eclat_live_close(live);
}

static void test_saves_are_repeated_by_their_commands(void)
{
    told t;
    eclat_live *live = open_live(make_job(SCENE, OUT "c.exr"), NULL, &t);
    eclat_view_request view = small_view(live);
    const uint32_t lost = eclat_live_save(live, &view); /* the scene is not there yet, */
    view.env_degrees = 0.5;
    eclat_live_set_view(live, &view);                       /* now another picture is requested */
    eclat_status s = wait_for(live, &t, is_saved, lost);
    CHECK(s.is_unsaved && strstr(s.told, "moved") && !atomic_load(&t.saves));
    view.env_degrees = 0;
    settle(live, &t, &view);
    unlink(OUT "c.exr");
    s = wait_for(live, &t, is_saved, eclat_live_save(live, &view));
    CHECK_MSG(!s.is_unsaved && strstr(s.told, OUT "c.exr"), "%s", s.told);
    CHECK_MSG(!strstr(t.command, "--eye") && strstr(t.command, "--size=24x16") && strstr(t.command, "--spp=4"), "%s", t.command);
    check_repeats(t.command, OUT "c.exr");

    view.viewpoint = eclat_live_facts(live)->cameras[0];
    view.viewpoint.eye[0] += 0.1234567890123;
    view.is_moved = 1;
    settle(live, &t, &view);
    wait_for(live, &t, is_saved, eclat_live_save(live, &view));
    double given = NAN; /* all digits that the session has returned */
    const char *at = strstr(t.command, "--eye=");
    CHECK_MSG(at && sscanf(at, "--eye=%lf", &given) == 1 && given == view.viewpoint.eye[0], "%.17g: %s", view.viewpoint.eye[0], t.command);
    check_repeats(t.command, OUT "c-2.exr");
    eclat_live_close(live);
}

/* Paths from the lights, alone and beside the camera's: the window's picture has the bits of a render. By itself it traces none. */
static void test_light_paths(void)
{
    static const char *const given[] = {NULL, "0.25"};
    for (int i = 0; i < 2; i++) {
        told t;
        eclat_error err;
        eclat_job *job = make_job(ECLAT_SOURCE_DIR "/scenes/ring/ring.gltf", OUT "l.exr");
        if (given[i]) CHECK_MSG(eclat_job_set(job, "light-paths", given[i], &err) == ECLAT_OK, "%s", err.text);
        eclat_live *live = open_live(job, NULL, &t);
        eclat_view_request view = small_view(live);
        for (int k = 0; k < 2; k++) {
            view.integrator = k ? ECLAT_LIGHT : ECLAT_PATH;
            CHECK(settle(live, &t, &view).integrator == view.integrator);
            unlink(k ? OUT "l-2.exr" : OUT "l.exr");
            wait_for(live, &t, is_saved, eclat_live_save(live, &view));
            CHECK_MSG(strstr(t.command, k ? "--integrator=light" : i ? "--light-paths=0.25" : "--light-paths=0 ") != NULL, "%s", t.command);
            check_repeats(t.command, k ? OUT "l-2.exr" : OUT "l.exr");
        }
        eclat_live_close(live);
    }
}

static void copy(const char *from, const char *to)
{
    char text[4096];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    for (size_t size; in && out && (size = fread(text, 1, sizeof text, in));) fwrite(text, 1, size, out);
    CHECK(in && out && !fclose(in) && !fclose(out));
}

static void wait_for_load(eclat_live *live, told *t, uint32_t serial)
{
    while (eclat_live_facts(live)->serial < serial) sem_wait(&t->news);
}

static void test_files_change(void)
{
    told t;
    copy(SCENE, OUT "box.gltf");
    copy(ECLAT_SOURCE_DIR "/scenes/cornell-box/cornell-box.bin", ECLAT_TEST_OUT "/cornell-box.bin");
    eclat_live *live = open_live(make_job(OUT "box.gltf", OUT "d.exr"), NULL, &t);
    eclat_view_request view = small_view(live);
    settle(live, &t, &view);
    const eclat_viewpoint before = eclat_live_facts(live)->cameras[0];
    copy(SCENE, OUT "box.gltf"); /* the session notices this by itself */
    wait_for_load(live, &t, 2);
    CHECK(eclat_live_facts(live)->cameras[0].eye[2] == before.eye[2]);
    view.reloads++;
    CHECK(!settle(live, &t, &view).has_failed);
    wait_for_load(live, &t, 3);
    eclat_live_close(live);
}

static void test_what_cannot_be_opened(void)
{
    told t;
    eclat_error err;
    eclat_live *live = (eclat_live *)&t;
    eclat_job *job = make_job(SCENE, OUT "e.exr");
    CHECK(eclat_live_open(job, "no.exr", NULL, &live, &err) == ECLAT_FAILED && !live && strstr(err.text, "no.exr"));
    CHECK(eclat_job_set(job, "checkpoint", OUT "f.exr", &err) == ECLAT_OK);
    CHECK(eclat_live_open(job, NULL, NULL, &live, &err) == ECLAT_USAGE && !live && strstr(err.text, "--checkpoint"));
    eclat_job_free(job);
    live = open_live(make_job("no-such-scene.gltf", OUT "g.exr"), NULL, &t);
    const eclat_status s = wait_for(live, &t, is_settled, 0);
    CHECK(s.has_failed == 1 + ECLAT_TROUBLE_FILES && strstr(s.trouble[ECLAT_TROUBLE_FILES], "no-such-scene.gltf") && !eclat_live_facts(live)->serial);
    eclat_live_close(live);
    eclat_live_close(NULL);
}

int main(void)
{
    if (test_tier("quick")) {
        test_a_picture_and_what_is_known_of_it();
        test_views_change_it();
        test_files_change();
        test_what_cannot_be_opened();
    }
    if (test_tier("full")) {
        test_a_view_denoises();
        test_saves_are_repeated_by_their_commands();
        test_light_paths();
    }
    TEST_END();
}
