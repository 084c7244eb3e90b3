/* A job becomes a picture. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "jobs/command_line.h"
#include "jobs/sequence.h"
#include "lib/internal.h"

ec_result ec_lib_read_options(const eclat_job *job, ec_render_request *request, ec_given_options *list, ec_error *err)
{
    bool given[EC_OPTIONS_MAX] = {false};
    ec_render_request_start(request);
    request->scene = job->scene;
    list->count = 0;
    for (size_t i = 0; i < job->option_count; i++) {
        const ec_lib_option *option = &job->options[i];
        const ec_option *row = ec_lib_find_option(option->name);
        EC_TRY(row->set(request, row->name, option->value, err));
        given[row - ec_render_rows] = true;
        if (list->count == EC_GIVEN_MAX) return ec_fail(err, "more than %d options", EC_GIVEN_MAX);
        list->list[list->count].option = row->name;
        list->list[list->count++].value = option->value;
    }
    return ec_render_request_settle(request, ec_render_rows, ec_render_row_count, given, err);
}

/* The command that renders the same picture, for the file's attributes and for checkpoints. */
static ec_result make_command(eclat_picture *p, ec_error *err)
{
    const eclat_job *job = p->options;
    bool is_whole = (p->words = calloc(job->option_count + 3, sizeof *p->words)) != NULL;
    for (size_t i = 0; is_whole && i < job->option_count + 3; i++) {
        const ec_lib_option option = i < 2 || i == job->option_count + 2 ? (ec_lib_option){0} : job->options[i - 2];
        const char *name = i == 0 ? "eclat" : i == 1 ? "render" : option.name ? option.name : job->scene;
        const size_t size = strlen(name) + (option.value ? strlen(option.value) : 0) + 4;
        char *word = p->words[p->word_count++] = malloc(size);
        if (word) snprintf(word, size, "%s%s%s%s", option.name ? "--" : "", name, option.value ? "=" : "", option.value ? option.value : "");
        is_whole = word != NULL;
    }
    if (is_whole) p->command = ec_command_line(p->word_count, p->words);
    return p->command ? EC_OK : ec_fail(err, "out of memory for a job's options");
}

static ec_result write_rendered(eclat_picture *picture, ec_outputs *outputs, ec_error *err)
{
    const char *names[EC_OUTPUTS_MAX];
    ec_render_report report = ec_render_job_report(&picture->job, names);
    return ec_render_job_write(&picture->job, outputs, &report, err);
}

/* With files to write as the command would; else into memory alone. */
static ec_result render(eclat_picture *picture, ec_error *err)
{
    ec_render_job *job = &picture->job;
    const double start = ec_now();
    if (!picture->request.outputs.count) {
        EC_TRY(ec_render_job_load(job, err));
        return ec_render_job_run(job, err);
    }
    EC_TRY(ec_render_job_prepare(job, err));
    return ec_render_job_complete(job, start, err);
}

static ec_result make_picture(eclat_job *job, eclat_picture *picture, ec_error *err)
{
    ec_lib_ear ear = {&picture->options->listener, &job->is_stopped};
    const ec_listener listener = ec_lib_listener(&ear);
    ec_given_options given;
    picture->write = write_rendered;
    picture->options->listener = job->listener;
    EC_TRY(ec_lib_read_options(picture->options, &picture->request, &given, err));
    if (picture->request.frames.given) return ec_frames_render(&listener, &picture->request, NULL, &given, ec_now(), err);
    if (!getcwd(picture->folder, sizeof picture->folder)) picture->folder[0] = 0;
    EC_TRY(make_command(picture, err));
    picture->job = (ec_render_job){.request = &picture->request, .listener = &listener, .takes_several = true, .in_memory = !picture->request.outputs.count,
                                   .program = "eclat", .command = picture->command, .job = {.argc = picture->word_count - 1, .argv = picture->words + 1, .folder = picture->folder}};
    ec_result result = render(picture, err);
    picture->job.listener = NULL; /* it ends here */
    return result;
}

eclat_result eclat_job_render(eclat_job *job, eclat_picture **picture, eclat_error *err)
{
    ec_error why = {0}, unfinished = {0};
    eclat_picture *made = calloc(1, sizeof *made);
    *picture = NULL;
    if (made) made->options = ec_lib_job_copy(job);
    if (!made || !made->options) {
        eclat_picture_free(made);
        return ec_lib_end(ec_fail(&why, "out of memory for a picture"), &why, err);
    }
    ec_result result = make_picture(job, made, &why);
    atomic_store(&job->is_stopped, 0);
    const bool has_film = made->job.film.batch_count && made->job.stats.samples;
    if (has_film && ec_lib_picture_finish(made, &unfinished) == EC_OK) {
        *picture = made;
        return ec_lib_end(result, &why, err);
    }
    if (result == EC_OK && has_film) why = unfinished, result = EC_FAILED;
    eclat_picture_free(made);
    return ec_lib_end(result, &why, err);
}
