/* tier: quick */
/* libeclat by its public functions alone: tables, options, every kind of job, pictures, stopping, threads, and that it prints nothing. */
#include <eclat/eclat.h>

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "support/test.h"

#define SCENE ECLAT_SOURCE_DIR "/scenes/cornell-box/cornell-box.gltf"
#define OUT ECLAT_TEST_OUT "/library-"

static void set(eclat_job *job, const char *option, const char *value)
{
    eclat_error err;
    CHECK_MSG(eclat_job_set(job, option, value, &err) == ECLAT_OK, "%s", err.text);
}

static eclat_job *make_command(const char *command, const char *input)
{
    eclat_error err;
    eclat_job *job = NULL;
    CHECK_MSG(eclat_job_new(command, &job, &err) == ECLAT_OK, "%s", err.text);
    if (input) CHECK_MSG(eclat_job_add(job, input, &err) == ECLAT_OK, "%s", err.text);
    return job;
}

static eclat_job *make_job(const char *spp)
{
    eclat_job *job = make_command("render", SCENE);
    set(job, "size", "24x16");
    set(job, "spp", spp);
    return job;
}

static eclat_picture *render(eclat_job *job)
{
    eclat_error err;
    eclat_picture *picture = NULL;
    CHECK_MSG(eclat_job_run(job, &picture, &err) == ECLAT_OK, "%s", err.text);
    if (!picture) exit(1);
    return picture;
}

static bool is_alike(const eclat_picture *a, const eclat_picture *b, const char *name)
{
    const eclat_channel x = eclat_picture_channel(a, name), y = eclat_picture_channel(b, name);
    bool same = x.data && y.data && eclat_picture_width(a) == eclat_picture_width(b) && eclat_picture_height(a) == eclat_picture_height(b);
    const size_t pixels = (size_t)eclat_picture_width(a) * eclat_picture_height(a);
    for (size_t i = 0; same && i < pixels; i++) same = x.data[i * x.stride] == y.data[i * y.stride];
    return same;
}

/* The picture's mean by its channels, as its error has it. */
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

static eclat_option find_option(const char *command, const char *name)
{
    eclat_option option;
    for (size_t i = 0; (option = eclat_option_at(command, i)).name && strcmp(option.name, name);) i++;
    return option;
}

static void test_tables(void)
{
    const eclat_command *command, *last = NULL;
    for (size_t i = 0; (command = eclat_command_at(i)); i++, last = command) {
        int group = 0;
        eclat_option option;
        CHECK(*command->name && *command->operands && *command->summary && *command->intro);
        CHECK_MSG(!last || strcmp(last->name, command->name) < 0, "%s comes too late", command->name);
        for (size_t k = 0; (option = eclat_option_at(command->name, k)).name; group = option.group, k++) {
            CHECK_MSG(*option.help && *option.group_title && option.group >= group, "%s --%s", command->name, option.name);
            CHECK_MSG(!option.takes_value == !option.metavar, "%s --%s", command->name, option.name);
        }
        for (const eclat_note *note = command->notes; note && note->heading; note++) CHECK(*note->heading && *note->term && *note->text);
        eclat_job_free(make_command(command->name, NULL));
    }
    CHECK(last && !strcmp(last->name, "view") && !eclat_command_at(999));
    CHECK(!eclat_option_at("render", 999).name && !eclat_option_at("paint", 0).name);
    CHECK(find_option("render", "spp").takes_value == 1 && find_option("render", "adaptive").takes_value == 2);
    CHECK(find_option("render", "output").letter == 'o' && find_option("render", "output").repeats && !find_option("render", "spp").repeats);
    CHECK(!strcmp(find_option("render", "tonemap").choices[0], "neutral") && !strcmp(find_option("render", "tonemap").otherwise, "neutral"));
    CHECK(find_option("info", "env").is_borrowed && !find_option("info", "json").is_borrowed);
    CHECK(find_option("view", "json").refused && !find_option("render", "json").refused && !find_option("cost", "spp").name);
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
    /* What does not go together is said when it runs, and so is a scene that is not there. */
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
    eclat_job_free(job); /* pictures outlive it */
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

/* What the listener hears, and when it stops the render. */
typedef struct heard {
    eclat_job *job;
    atomic_int events;
    int messages, stops_by; /* 0: not; 1: its answer; 2: eclat_job_stop */
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

/* Before an error is known nothing of the way to it is done. */
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
        picture = render(job); /* a stop is of one render */
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
        CHECK(i == 1 || eclat_job_set(slice, "output", slices[i], &err) == ECLAT_OK); /* by the render, or afterwards */
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
    eclat_job_free(merge); /* pictures outlive it */
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

/* A triangle that moves for a second. */
static const char moving[] =
    "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
    "'animations':[{'channels':[{'sampler':0,'target':{'node':0,'path':'translation'}}],'samplers':[{'input':1,'output':2}]}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3','min':[0,0,0],'max':[1,1,0]},"
    "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,'type':'SCALAR','min':[0],'max':[1]},"
    "{'bufferView':0,'byteOffset':44,'componentType':5126,'count':2,'type':'VEC3'}],'bufferViews':[{'buffer':0,'byteLength':68}],"
    "'buffers':[{'byteLength':68,'uri':'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAA='}]}";

static const char *write_moving(void)
{
    FILE *file = fopen(OUT "moving.gltf", "w");
    for (const char *c = moving; file && *c; c++) fputc(*c == '\'' ? '"' : *c, file);
    if (file) fclose(file);
    return OUT "moving.gltf";
}

/* What a job tells. */
typedef struct told {
    char text[1 << 16];
    int reports, begins, ends, steps, messages;
    const char *refusal;
} told;

static const char *take_report(void *user, const char *text, size_t size)
{
    told *t = user;
    const size_t used = strlen(t->text);
    CHECK(size > 0 && strlen(text) == size && used + size < sizeof t->text);
    memcpy(t->text + used, text, size + 1);
    t->reports++;
    return t->refusal;
}

static void take_begin(void *user, int has_progress) { ((told *)user)->begins += has_progress; }
static void take_end(void *user) { ((told *)user)->ends++; }

static int take_progress(void *user, const eclat_progress *progress)
{
    ((told *)user)->steps += *progress->text != 0;
    return 1;
}

static void take_message(void *user, eclat_severity severity, const char *text)
{
    CHECK(*text);
    ((told *)user)->messages += severity < ECLAT_WARNING;
}

static eclat_result listen_and_run(eclat_job *job, told *t, eclat_error *err)
{
    const char *refusal = t->refusal;
    *t = (told){.refusal = refusal};
    eclat_job_listen(job, &(eclat_listener){.user = t, .report = take_report, .begin = take_begin, .end = take_end, .progress = take_progress, .message = take_message});
    return eclat_job_run(job, NULL, err);
}

static void test_reports(void)
{
    static told t;
    char *const words[] = {"tool", "my scene", "-x"};
    eclat_error err;
    eclat_job *job = make_job("8");
    set(job, "output", OUT "told.exr");
    CHECK_MSG(listen_and_run(job, &t, &err) == ECLAT_OK, "%s", err.text);
    CHECK(t.reports == 1 && strstr(t.text, "told.exr") && t.begins == 1 && t.ends == 1 && t.steps > 0 && t.messages > 0);
    CHECK(eclat_job_typed(job, 3, words, &err) == ECLAT_OK);
    set(job, "json", NULL);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && *t.text == '{' && strstr(t.text, "tool 'my scene' -x") && strstr(t.text, "}\n"));
    t.refusal = "the pipe is closed";
    CHECK(listen_and_run(job, &t, &err) == ECLAT_FAILED && !strcmp(err.text, t.refusal));
    t.refusal = NULL;
    eclat_job_free(job);
    job = make_job("8");
    set(job, "output", OUT "told.exr");
    set(job, "quiet", NULL);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && !t.reports && !t.messages && t.steps > 0);
    set(job, "frames", "0:1");
    set(job, "json", NULL);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_USAGE && strstr(err.text, "%04d"));
    eclat_job_free(job);
    job = make_command("render", write_moving());
    set(job, "size", "8x8");
    set(job, "spp", "8");
    set(job, "frames", "0:1");
    set(job, "json", NULL);
    set(job, "overwrite", NULL);
    set(job, "output", OUT "frame-%d.exr");
    CHECK_MSG(listen_and_run(job, &t, &err) == ECLAT_OK && t.reports == 3 && strstr(t.text, "\"frames\":2"), "%s", err.text);
    eclat_job_free(job);
}

static void test_commands(void)
{
    static told t;
    eclat_error err;
    eclat_picture *picture = (eclat_picture *)&err;
    eclat_job *job = make_command("info", SCENE);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && strstr(t.text, "triangles") && !t.begins);
    CHECK(eclat_job_run(job, &picture, &err) == ECLAT_OK && !picture);
    eclat_job_free(job);
    job = make_command("devices", NULL);
    set(job, "json", NULL);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && *t.text == '{');
    eclat_job_free(job);
    job = make_command("selftest", NULL);
    set(job, "only", "numbers/");
    CHECK_MSG(listen_and_run(job, &t, &err) == ECLAT_OK && strstr(t.text, "passed") && t.steps > 0 && t.begins == 1, "%s", err.text);
    CHECK(!eclat_job_says_no(job));
    eclat_job_free(job);
    job = make_command("cost", SCENE);
    set(job, "budget", "2s");
    set(job, "size", "8x8");
    set(job, "json", "-");
    CHECK_MSG(listen_and_run(job, &t, &err) == ECLAT_OK && *t.text == '{' && strstr(t.text, "\"rungs\"") && t.steps > 0, "%s", err.text);
    eclat_job_free(job);
}

static void test_comparing(void)
{
    static told t;
    eclat_error err;
    for (int i = 0; i < 2; i++) {
        eclat_job *job = make_job("64");
        set(job, "output", i ? OUT "dim.exr" : OUT "bright.exr");
        if (i) set(job, "without", "emission");
        if (i) set(job, "env", "1,0,0");
        CHECK(eclat_job_run(job, NULL, &err) == ECLAT_OK);
        eclat_job_free(job);
    }
    eclat_job *job = make_command("compare", OUT "bright.exr");
    CHECK(listen_and_run(job, &t, &err) == ECLAT_USAGE);
    CHECK(eclat_job_add(job, OUT "dim.exr", &err) == ECLAT_OK);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && eclat_job_says_no(job) && strstr(t.text, "differ"));
    eclat_job_free(job);
    job = make_command("compare", OUT "dim.exr");
    CHECK(eclat_job_add(job, OUT "dim.exr", &err) == ECLAT_OK);
    CHECK(listen_and_run(job, &t, &err) == ECLAT_OK && !eclat_job_says_no(job));
    eclat_job_free(job);
}

/* What is gone on with has the bits of one run, and says which one that is. */
static void test_resuming(void)
{
    eclat_error err;
    eclat_picture *resumed = NULL;
    eclat_job *job = make_job("128");
    eclat_picture *whole = render(job);
    eclat_job_free(job);
    job = make_job("64");
    set(job, "checkpoint", OUT "kept.exr");
    eclat_picture_free(render(job));
    eclat_job_free(job);
    job = make_command("render", NULL);
    set(job, "resume", OUT "kept.exr");
    set(job, "spp", "128");
    CHECK_MSG(eclat_job_run(job, &resumed, &err) == ECLAT_OK && resumed, "%s", err.text);
    CHECK(is_alike(whole, resumed, "R") && is_alike(whole, resumed, "stderr.B"));
    CHECK(!strcmp(eclat_picture_attribute(resumed, "eclat.command").text, "eclat render " SCENE " --size 24x16 --spp 128"));
    eclat_picture_free(resumed);
    eclat_job_free(job);
    job = make_command("render", NULL);
    set(job, "resume", "none.exr");
    CHECK(eclat_job_run(job, &resumed, &err) == ECLAT_FAILED && !resumed && strstr(err.text, "none.exr"));
    eclat_job_free(job);
    eclat_picture_free(whole);
}

/* A process that no launcher has started. */
static void test_alone(void)
{
    eclat_error err;
    eclat_ranks *ranks = (eclat_ranks *)&err;
    CHECK(eclat_ranks_join(&ranks, &err) == ECLAT_OK && !ranks && eclat_ranks_number(ranks) == 0);
    eclat_ranks_leave(ranks);
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

/* Everything with both standard streams in a file, which stays empty. */
int main(void)
{
    const char *path = OUT "printed.txt";
    FILE *printed = fopen(path, "w+");
    const int out = dup(STDOUT_FILENO), error = dup(STDERR_FILENO);
    if (!printed) return 1;
    test_devices();
    test_tables();
    test_options();
    fflush(stdout);
    dup2(fileno(printed), STDOUT_FILENO);
    dup2(fileno(printed), STDERR_FILENO);
    eclat_picture *picture = NULL;
    eclat_job *job = make_job("16");
    const eclat_result result = eclat_job_run(job, &picture, NULL);
    eclat_picture_free(picture);
    eclat_job_free(job);
    test_commands(); /* which report */
    fflush(NULL);
    const off_t size = lseek(fileno(printed), 0, SEEK_END);
    dup2(out, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    CHECK_MSG(result == ECLAT_OK && size == 0, "a render printed %ld bytes to %s", (long)size, path);
    fclose(printed);
    test_picture();
    test_stopping();
    test_fraction();
    test_threads();
    test_files();
    test_reports();
    test_comparing();
    test_resuming();
    test_alone();
    TEST_END();
}
