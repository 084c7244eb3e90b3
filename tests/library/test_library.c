/* tier: quick */
/* libeclat by its public functions alone: options, pictures, stopping, threads, files, and that it prints nothing. */
#include <eclat/eclat.h>

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "library/job.h"

#define OUT ECLAT_TEST_OUT "/library-"

/* The picture's mean over its channels, with weights as in its error. */
static double mean_luminance(const eclat_picture *p)
{
    const double weights[3] = {0.2126, 0.7152, 0.0722};
    const size_t pixels = (size_t)eclat_picture_width(p) * eclat_picture_height(p);
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const eclat_channel channel = eclat_picture_channel(p, (const char *[]){"R", "G", "B"}[c]);
        for (size_t i = 0; i < pixels; i++) sum += weights[c] * (double)channel.data[i * channel.stride];
    }
    return sum / (double)pixels;
}

static void test_options(void)
{
    eclat_error err;
    eclat_job *job = make_job("8");
    CHECK(eclat_job_set(job, "sppp", "8", &err) == ECLAT_USAGE && strstr(err.text, "sppp"));
    CHECK(eclat_job_set(job, "spp", "0", &err) == ECLAT_USAGE && strstr(err.text, "spp"));
    CHECK(eclat_job_set(job, "spp", NULL, &err) == ECLAT_USAGE && eclat_job_set(job, "overwrite", "yes", &err) == ECLAT_USAGE);
    CHECK(eclat_job_set(job, "output", OUT "twice.exr", &err) == ECLAT_OK && eclat_job_set(job, "output", OUT "twice.exr", &err) == ECLAT_USAGE);
    CHECK(eclat_job_set(job, "adaptive", NULL, &err) == ECLAT_OK && eclat_job_set(job, NULL, NULL, NULL) == ECLAT_USAGE);
    CHECK(!strcmp(eclat_version(), EC_VERSION));
    /* Incompatible options, and missing scenes, are reported when the job runs. */
    eclat_picture *picture = (eclat_picture *)job;
    CHECK(eclat_job_set(job, "samples", "0:8", &err) == ECLAT_OK);
    CHECK(eclat_job_run(job, &picture, &err) == ECLAT_USAGE && !picture && strstr(err.text, "--adaptive"));
    eclat_job_free(job);
    job = make_command("render", "no-such-scene.gltf");
    CHECK(eclat_job_run(job, &picture, &err) == ECLAT_FAILED && !picture && strstr(err.text, "no-such-scene.gltf"));
    CHECK(eclat_job_add(job, SCENE, &err) == ECLAT_OK && eclat_job_run(job, &picture, &err) == ECLAT_USAGE && strstr(err.text, "one scene"));
    eclat_job_free(job);
    job = make_command("render", NULL);
    CHECK(eclat_job_run(job, &picture, &err) == ECLAT_USAGE && strstr(err.text, "needs a SCENE"));
    eclat_job_free(job);
    CHECK(eclat_job_new("paint", &job, &err) == ECLAT_USAGE && !job && strstr(err.text, "paint"));
    eclat_job_free(NULL);
    eclat_picture_free(NULL);
}

static void test_picture(void)
{
    eclat_error err;
    eclat_job *job = make_job("64");
    CHECK(eclat_job_set(job, "seed", "7", &err) == ECLAT_OK);
    eclat_picture *picture = render(job), *other = render(job);
    eclat_job_free(job); /* pictures outlive the job */
    CHECK(eclat_picture_width(picture) == 24 && eclat_picture_height(picture) == 16);
    const eclat_picture_error error = eclat_picture_get_error(picture);
    CHECK(error.error > 0.001 && error.error < 1 && error.error_bound > error.error && isfinite(error.error_bound) && !error.why);
    CHECK(error.samples_per_pixel == 64 && error.replicates > 1 && error.mean_luminance > 0);
    CHECK_NEAR(mean_luminance(picture), error.mean_luminance, 1e-5 * error.mean_luminance);
    CHECK(eclat_picture_channel(picture, "stderr.Y").data && !eclat_picture_channel(picture, "X").data);
    CHECK(eclat_picture_channel_count(picture) > 10 && eclat_picture_channel_at(picture, 0).data && !eclat_picture_channel_at(picture, 999).name);
    CHECK(!strcmp(eclat_picture_attribute(picture, "eclat.seed").text, "7"));
    CHECK(eclat_picture_attribute(picture, "eclat.error").number == error.error && !eclat_picture_attribute(picture, "eclat.error").text);
    CHECK(strstr(eclat_picture_attribute(picture, "eclat.command").text, " --seed 7") != NULL);
    CHECK(!eclat_picture_attribute(picture, "eclat.none").name && eclat_picture_attribute_count(picture) > 20);
    CHECK(is_alike(picture, other, "R") && is_alike(picture, other, "stderr.G"));

    eclat_comparison comparison;
    CHECK_MSG(eclat_picture_write(picture, OUT "a.exr", &err) == ECLAT_OK, "%s", err.text);
    CHECK_MSG(eclat_picture_write(picture, OUT "a.png", &err) == ECLAT_OK, "%s", err.text);
    CHECK(eclat_picture_write(picture, OUT "a.gif", &err) != ECLAT_OK && access(OUT "a.gif", F_OK) != 0);
    CHECK(eclat_picture_write(picture, OUT "none/a.exr", &err) == ECLAT_FAILED && strstr(err.text, "none"));
    CHECK_MSG(eclat_compare(OUT "a.exr", OUT "a.exr", &comparison, &err) == ECLAT_OK, "%s", err.text);
    CHECK(comparison.rmse == 0 && !comparison.differ && comparison.p > 0.05);
    CHECK(eclat_compare(OUT "a.exr", "none.exr", &comparison, &err) == ECLAT_FAILED);
    eclat_picture_free(picture);
    eclat_picture_free(other);
}

/* Records what the listener gets, and how it stops the render. */
typedef struct heard {
    eclat_job *job;
    atomic_int events;
    int messages, stops_by; /* how to stop: 0: not; 1: by the answer; 2: by eclat_job_stop */
    double first_fraction;
} heard;

static void count_message(void *user, eclat_severity severity, const char *text)
{
    ((heard *)user)->messages += severity <= ECLAT_FAILURE && *text;
}

static int count_progress(void *user, const eclat_progress *progress)
{
    heard *h = user;
    atomic_fetch_add(&h->events, 1);
    CHECK(progress->fraction >= 0 && progress->fraction <= 1);
    if (atomic_load(&h->events) == 1) h->first_fraction = progress->fraction;
    if (h->stops_by == 2) eclat_job_stop(h->job);
    return h->stops_by != 1;
}

/* No error is known yet, so progress towards it is 0. */
static void test_fraction(void)
{
    eclat_error err;
    eclat_job *job = make_job("16000000");
    heard h = {.job = job, .stops_by = 1, .first_fraction = -1};
    eclat_job_listen(job, &(eclat_listener){.user = &h, .progress = count_progress});
    CHECK(eclat_job_set(job, "error", "0.01%", &err) == ECLAT_OK);
    eclat_picture_free(render(job));
    CHECK_MSG(h.first_fraction >= 0 && h.first_fraction < 0.5, "%g of the way is done at first", h.first_fraction);
    eclat_job_free(job);
}

static void *stop_after_progress(void *user)
{
    heard *h = user;
    while (atomic_load(&h->events) == 0) sched_yield();
    eclat_job_stop(h->job);
    return NULL;
}

static void test_stopping(void)
{
    for (int how = 0; how < 3; how++) { /* by another thread, by the answer, within the callback */
        eclat_job *job = make_job("16000000");
        heard h = {.job = job, .stops_by = how};
        const eclat_listener listener = {.user = &h, .message = count_message, .progress = count_progress};
        pthread_t thread;
        eclat_job_listen(job, &listener);
        if (how == 0) pthread_create(&thread, NULL, stop_after_progress, &h);
        eclat_picture *picture = render(job);
        if (how == 0) pthread_join(thread, NULL);
        CHECK(eclat_picture_get_error(picture).samples_per_pixel < 16000000 && h.messages > 0 && h.events > 0);
        CHECK(!strcmp(eclat_picture_attribute(picture, "eclat.stoppedBy").text, "user"));
        eclat_picture_free(picture);
        CHECK(eclat_job_set(job, "spp", "8", NULL) == ECLAT_OK);
        h.stops_by = 0;
        picture = render(job); /* a stop ends one render only */
        CHECK(eclat_picture_get_error(picture).samples_per_pixel == 8);
        eclat_picture_free(picture);
        eclat_job_free(job);
    }
}

static void *render_apart(void *job) { return render(job); }

static void test_threads(void)
{
    enum { THREADS = 3 };
    pthread_t threads[THREADS];
    eclat_job *jobs[THREADS];
    void *pictures[THREADS];
    for (int i = 0; i < THREADS; i++) {
        jobs[i] = make_job("32");
        CHECK(pthread_create(&threads[i], NULL, render_apart, jobs[i]) == 0);
    }
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], &pictures[i]);
    for (int i = 1; i < THREADS; i++) CHECK(is_alike(pictures[0], pictures[i], "G"));
    for (int i = 0; i < THREADS; i++) eclat_picture_free(pictures[i]), eclat_job_free(jobs[i]);
}

static void test_files(void)
{
    static const char *const slices[] = {OUT "0.exr", OUT "1.exr"}, *const samples[] = {"0:64", "64:128"};
    eclat_error err;
    eclat_job *job = make_job("128");
    eclat_picture *whole = render(job), *merged = NULL;
    for (int i = 0; i < 2; i++) {
        eclat_job *slice = make_job("128");
        CHECK(eclat_job_set(slice, "samples", samples[i], &err) == ECLAT_OK);
        CHECK(i == 1 || eclat_job_set(slice, "output", slices[i], &err) == ECLAT_OK); /* by the render, or later */
        eclat_picture *part = render(slice);
        CHECK(eclat_picture_get_error(part).samples_per_pixel == 64);
        CHECK(i == 0 || eclat_picture_write(part, slices[i], &err) == ECLAT_OK);
        eclat_picture_free(part);
        eclat_job_free(slice);
    }
    eclat_job *merge = make_command("merge", slices[0]);
    CHECK(eclat_job_run(merge, &merged, &err) == ECLAT_FAILED && !merged && strstr(err.text, "64:128"));
    CHECK(eclat_job_run(merge, NULL, &err) == ECLAT_USAGE && strstr(err.text, "-o ALL.exr"));
    CHECK(eclat_job_add(merge, slices[1], &err) == ECLAT_OK);
    CHECK_MSG(eclat_job_run(merge, &merged, &err) == ECLAT_OK && merged, "%s", err.text);
    eclat_job_free(merge); /* pictures outlive the job */
    CHECK(is_alike(whole, merged, "R") && is_alike(whole, merged, "stderr.B"));
    CHECK(eclat_picture_get_error(merged).error == eclat_picture_get_error(whole).error);
    CHECK(eclat_picture_attribute(merged, "eclat.samplesPerPixel").number == 128);
    CHECK_MSG(eclat_picture_write(merged, OUT "merged.exr", &err) == ECLAT_OK, "%s", err.text);
    eclat_picture_free(whole);
    eclat_picture_free(merged);
    eclat_job_free(job);
    merge = make_command("merge", NULL);
    CHECK(eclat_job_run(merge, &merged, &err) == ECLAT_USAGE);
    eclat_job_free(merge);
}

static void test_devices(void)
{
    eclat_error err;
    eclat_device *devices;
    size_t count, usable = 0;
    CHECK_MSG(eclat_devices_list(&devices, &count, &err) == ECLAT_OK, "%s", err.text);
    for (size_t i = 0; i < count; i++) usable += devices[i].is_usable && *devices[i].name && devices[i].compute_units > 0;
    CHECK(usable > 0);
    eclat_devices_free(devices);
}

static void render_once(void)
{
    eclat_picture *picture = NULL;
    eclat_job *job = make_job("16");
    CHECK(eclat_job_run(job, &picture, NULL) == ECLAT_OK);
    eclat_picture_free(picture);
    eclat_job_free(job);
}

int main(void)
{
    test_devices();
    test_options();
    check_silence(render_once, OUT "printed.txt");
    test_picture();
    test_stopping();
    test_fraction();
    test_threads();
    test_files();
    TEST_END();
}
