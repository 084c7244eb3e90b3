/* tier: quick */
/* Every kind of job by the library's public functions: tables of commands and options, reports, answers, resuming. */
#include "library/job.h"

#define OUT ECLAT_TEST_OUT "/jobs-"

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
    CHECK(!strcmp(find_option("render", "tonemap").choices[ECLAT_TONEMAP_AGX], "agx") && !strcmp(find_option("render", "tonemap").otherwise, "neutral"));
    CHECK(find_option("info", "env").is_borrowed && !find_option("info", "json").is_borrowed);
    CHECK(find_option("view", "json").refused && !find_option("render", "json").refused && !find_option("cost", "spp").name);
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

/* Messages of a job. */
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
    const eclat_listener listener = {.user = t, .report = take_report, .begin = take_begin, .end = take_end, .progress = take_progress,
                                     .message = take_message};
    eclat_job_listen(job, &listener);
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

/* A resumed job has the bits of one run, and names the resumed file. */
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

/* Runs as if no launcher had started the process. */
static void test_alone(void)
{
    eclat_error err;
    eclat_ranks *ranks = (eclat_ranks *)&err;
    CHECK(eclat_ranks_join(&ranks, &err) == ECLAT_OK && !ranks && eclat_ranks_number(ranks) == 0);
    eclat_ranks_leave(ranks);
}

int main(void)
{
    test_tables();
    check_silence(test_commands, OUT "printed.txt");
    test_reports();
    test_comparing();
    test_resuming();
    test_alone();
    TEST_END();
}
