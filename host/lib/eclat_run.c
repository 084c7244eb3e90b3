/* Runs a job as a call of its command. */
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>

#include "jobs/given.h"
#include "lib/internal.h"

/* Copies everything of the job that a picture keeps. */
static ec_result copy(const eclat_job *job, eclat_picture *p, ec_error *err)
{
    ec_call *call = &p->call;
    EC_TRY(ec_given_add_all(&call->given, &job->given, job->rows, job->row_count, 0, err));
    for (int i = 0; i < job->input_count; i++) EC_TRY(ec_lib_add_text(&call->inputs, &call->input_count, job->inputs[i], err));
    EC_TRY(ec_words_make(&call->words, job->command->told.name, call->inputs, call->input_count, &call->given, job->rows, job->row_count, err));
    p->line = job->line ? strdup(job->line) : ec_command_line(call->words.count, call->words.list);
    call->request = calloc(1, job->command->size + 1);
    if (!p->line || !call->request) return ec_fail(err, "out of memory for a job");
    if (job->command->start) job->command->start(call->request);
    return ec_given_apply(&call->given, job->rows, job->row_count, call->request, call->is_given, err);
}

/* Returns a descriptor that becomes readable when the job has to stop. */
static int find_descriptor(eclat_job *job)
{
    eventfd_t stops;
    if (job->wakes < 0) atomic_store(&job->wakes, eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    eventfd_read(job->wakes, &stops); /* clears that of a previous run */
    if (atomic_load(&job->is_stopped)) eventfd_write(job->wakes, 1);
    return job->wakes;
}

static ec_result run(eclat_job *job, eclat_picture *p, const ec_listener *listener, ec_error *err)
{
    ec_call *call = &p->call;
    EC_TRY(copy(job, p, err));
    call->listener = listener;
    call->json = ec_given_has(&call->given, "json");
    call->quiet = ec_given_has(&call->given, "quiet");
    call->program = job->program ? job->program : "eclat";
    call->line = p->line;
    call->stop = job->command->is_interactive ? find_descriptor(job) : -1;
    if (job->command->is_shared) call->ranks = job->ranks;
    else if (job->ranks) ec_note(&listener->log, "only render runs on several ranks; rank 0 does this alone");
    ec_result result = job->command->run ? job->command->run(call, err) : ec_lib_view(job, call, err), told = listener->report(listener->user, result == EC_OK ? err : NULL);
    return result == EC_OK ? told : result;
}

/* Tells whether there is a picture: also after a failure, if there are samples already. */
static bool has_picture(const ec_call *call, ec_result result)
{
    const bool has_film = call->render.film.batch_count && call->render.stats.samples;
    return call->wants_picture && (has_film || (result == EC_OK && (call->merged.picture.rgb || call->mix.picture.rgb)));
}

eclat_result eclat_job_run(eclat_job *job, eclat_picture **picture, eclat_error *err)
{
    ec_error why = {0}, unfinished = {0};
    ec_lib_ear ear = {.listener = &job->listener, .is_stopped = &job->is_stopped, .is_quiet = ec_given_has(&job->given, "quiet"),
                      .says_once = ec_given_has(&job->given, "frames") || ec_given_has(&job->given, "orbit")}; /* messages of frames are much alike */
    eclat_picture *made = calloc(1, sizeof *made);
    if (picture) *picture = NULL;
    ear.to = open_memstream(&ear.text, &ear.size);
    const ec_listener listener = ec_lib_listener(&ear);
    ec_result result = made && ear.to ? EC_OK : ec_fail(&why, "out of memory for a job");
    if (made) made->call.wants_picture = picture != NULL;
    if (result == EC_OK) result = run(job, made, &listener, &why);
    job->says_no = result == EC_OK && made->call.says_no;
    atomic_store(&job->is_stopped, 0);
    if (made && has_picture(&made->call, result)) {
        if (ec_lib_picture_finish(made, &unfinished) == EC_OK) *picture = made, made = NULL;
        else if (result == EC_OK) why = unfinished, result = EC_FAILED;
    }
    eclat_picture_free(made);
    if (ear.to) fclose(ear.to);
    free(ear.text);
    return ec_lib_end(result, &why, err);
}
