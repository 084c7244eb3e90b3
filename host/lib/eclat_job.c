#include <stdlib.h>
#include <string.h>

#include "jobs/usage.h"
#include "lib/internal.h"

const ec_option *ec_lib_find_option(const char *name)
{
    const ec_option *row = ec_render_row(name);
    return row && !(row->uses & EC_OPTION_COMMAND_LINE) ? row : NULL;
}

eclat_option eclat_option_at(size_t i)
{
    for (int row = 0; row < ec_render_row_count; row++)
        if (!(ec_render_rows[row].uses & EC_OPTION_COMMAND_LINE) && i-- == 0)
            return (eclat_option){ec_render_rows[row].name, ec_option_takes_value(&ec_render_rows[row])};
    return (eclat_option){0};
}

eclat_result eclat_job_new(const char *scene, eclat_job **job, eclat_error *err)
{
    ec_error why = {0};
    *job = NULL;
    if (!scene || !*scene) return ec_lib_end(ec_usage(&why, "a job needs a scene: the path of a .gltf or .glb"), &why, err);
    eclat_job *made = calloc(1, sizeof *made);
    if (made) made->scene = strdup(scene);
    if (!made || !made->scene) {
        free(made);
        return ec_lib_end(ec_fail(&why, "out of memory for a job"), &why, err);
    }
    *job = made;
    return ec_lib_end(EC_OK, &why, err);
}

void eclat_job_free(eclat_job *job)
{
    if (!job) return;
    for (size_t i = 0; i < job->option_count; i++) {
        free(job->options[i].name);
        free(job->options[i].value);
    }
    free(job->options);
    free(job->scene);
    free(job);
}

static ec_result append(eclat_job *job, const char *name, const char *value, ec_error *err)
{
    ec_lib_option *options = realloc(job->options, (job->option_count + 1) * sizeof *options);
    if (!options) return ec_fail(err, "out of memory for option %s", name);
    job->options = options;
    const ec_lib_option added = {strdup(name), value ? strdup(value) : NULL};
    if (!added.name || (value && !added.value)) {
        free(added.name);
        free(added.value);
        return ec_fail(err, "out of memory for option %s", name);
    }
    options[job->option_count++] = added;
    return EC_OK;
}

eclat_job *ec_lib_job_copy(const eclat_job *job)
{
    eclat_job *copy = calloc(1, sizeof *copy);
    bool is_whole = copy && (copy->scene = strdup(job->scene));
    for (size_t i = 0; is_whole && i < job->option_count; i++)
        is_whole = append(copy, job->options[i].name, job->options[i].value, NULL) == EC_OK;
    if (is_whole) return copy;
    eclat_job_free(copy);
    return NULL;
}

static ec_result check(const char *name, const char *value, ec_error *err)
{
    const ec_option *row = name ? ec_lib_find_option(name) : NULL;
    if (!row && name && ec_render_row(name))
        return ec_usage(err, "option %s is the command line's; a program has functions for it, or needs none", name);
    if (!row) return ec_usage(err, "there is no option %s; eclat_option_at lists them", name ? name : "(null)");
    if (row->metavar && !row->value_optional && !value) return ec_usage(err, "option %s needs a value", name);
    if (!row->metavar && value) return ec_usage(err, "option %s takes no value", name);
    ec_render_request scratch;
    ec_render_request_start(&scratch);
    return row->set(&scratch, name, value, err);
}

eclat_result eclat_job_set(eclat_job *job, const char *option, const char *value, eclat_error *err)
{
    ec_error why = {0};
    ec_result result = check(option, value, &why);
    if (result == EC_OK) result = append(job, option, value, &why);
    return ec_lib_end(result, &why, err);
}

void eclat_job_listen(eclat_job *job, const eclat_listener *listener) { job->listener = listener ? *listener : (eclat_listener){0}; }

void eclat_job_stop(eclat_job *job) { atomic_store(&job->is_stopped, 1); }
