#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "jobs/given.h"
#include "lib/internal.h"

ec_result ec_lib_add_text(char ***list, int *count, const char *text, ec_error *err)
{
    char **longer = realloc(*list, ((size_t)*count + 1) * sizeof *longer), *copy = strdup(text);
    if (longer) *list = longer;
    if (longer && copy) {
        longer[(*count)++] = copy;
        return EC_OK;
    }
    free(copy);
    return ec_fail(err, "out of memory for '%s'", text);
}

eclat_result eclat_job_new(const char *command, eclat_job **job, eclat_error *err)
{
    ec_error why = {0};
    const ec_command *found = command ? ec_command_find(command) : NULL;
    *job = NULL;
    if (!found) return ec_lib_end(ec_usage(&why, "there is no command %s; eclat_command_at lists them", command ? command : "(null)"), &why, err);
    eclat_job *made = calloc(1, sizeof *made);
    if (made) made->checked = calloc(1, found->size + 1);
    if (!made || !made->checked) {
        free(made);
        return ec_lib_end(ec_fail(&why, "out of memory for a job"), &why, err);
    }
    made->command = found;
    made->row_count = found->rows(made->rows);
    atomic_init(&made->wakes, -1);
    if (found->start) found->start(made->checked);
    *job = made;
    return ec_lib_end(EC_OK, &why, err);
}

void eclat_job_free(eclat_job *job)
{
    if (!job) return;
    if (job->wakes >= 0) close(job->wakes);
    while (job->input_count) free(job->inputs[--job->input_count]);
    free(job->inputs);
    ec_given_free(&job->given);
    free(job->checked);
    free(job->program);
    free(job->line);
    free(job);
}

eclat_result eclat_job_add(eclat_job *job, const char *input, eclat_error *err)
{
    ec_error why = {0};
    return ec_lib_end(ec_lib_add_text(&job->inputs, &job->input_count, input ? input : "", &why), &why, err);
}

static ec_result set(eclat_job *job, const char *name, const char *value, ec_error *err)
{
    const ec_option *row = name ? ec_options_find(job->rows, job->row_count, name) : NULL;
    if (!row) return ec_usage(err, "there is no option %s; eclat_option_at lists them", name ? name : "(null)");
    if (row->metavar && !row->value_optional && !value) return ec_usage(err, "option %s needs a value", name);
    if (!row->metavar && value) return ec_usage(err, "option %s takes no value", name);
    EC_TRY(ec_given_add(&job->given, row->name, value, err));
    ec_result result = ec_option_store(row, job->checked, job->given.list[job->given.count - 1].value, err);
    if (result != EC_OK) ec_given_drop_last(&job->given);
    return result;
}

eclat_result eclat_job_set(eclat_job *job, const char *option, const char *value, eclat_error *err)
{
    ec_error why = {0};
    return ec_lib_end(set(job, option, value, &why), &why, err);
}

eclat_result eclat_job_typed(eclat_job *job, int argc, char *const *argv, eclat_error *err)
{
    ec_error why = {0};
    char *program = argc > 0 ? strdup(argv[0]) : NULL, *line = program ? ec_command_line(argc, (char **)(uintptr_t)argv) : NULL;
    free(job->program);
    free(job->line);
    job->program = program;
    job->line = line;
    return ec_lib_end(line || argc < 1 ? EC_OK : ec_fail(&why, "out of memory"), &why, err);
}

void eclat_job_listen(eclat_job *job, const eclat_listener *listener) { job->listener = listener ? *listener : (eclat_listener){0}; }

void eclat_job_share(eclat_job *job, eclat_ranks *ranks) { job->ranks = (ec_ranks *)ranks; }

int eclat_job_says_no(const eclat_job *job) { return job->says_no; }

void eclat_job_stop(eclat_job *job)
{
    atomic_store(&job->is_stopped, 1);
    const int wakes = atomic_load(&job->wakes);
    if (wakes >= 0) eventfd_write(wakes, 1);
}
