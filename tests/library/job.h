/* Jobs that render a small picture, for tests of the library by its public functions. */
#ifndef EC_TESTS_LIBRARY_JOB_H
#define EC_TESTS_LIBRARY_JOB_H

#include <eclat/eclat.h>

#include <stdbool.h>
#include <unistd.h>

#include "support/test.h"

#define SCENE ECLAT_SOURCE_DIR "/scenes/cornell-box/cornell-box.gltf"

static inline void set(eclat_job *job, const char *option, const char *value)
{
    eclat_error err;
    CHECK_MSG(eclat_job_set(job, option, value, &err) == ECLAT_OK, "%s", err.text);
}

static inline eclat_job *make_command(const char *command, const char *input)
{
    eclat_error err;
    eclat_job *job = NULL;
    CHECK_MSG(eclat_job_new(command, &job, &err) == ECLAT_OK, "%s", err.text);
    if (input) CHECK_MSG(eclat_job_add(job, input, &err) == ECLAT_OK, "%s", err.text);
    return job;
}

static inline eclat_job *make_job(const char *spp)
{
    eclat_job *job = make_command("render", SCENE);
    set(job, "size", "24x16");
    set(job, "spp", spp);
    return job;
}

static inline eclat_picture *render(eclat_job *job)
{
    eclat_error err;
    eclat_picture *picture = NULL;
    CHECK_MSG(eclat_job_run(job, &picture, &err) == ECLAT_OK, "%s", err.text);
    if (!picture) exit(1);
    return picture;
}

static inline bool is_alike(const eclat_picture *a, const eclat_picture *b, const char *name)
{
    const eclat_channel x = eclat_picture_channel(a, name), y = eclat_picture_channel(b, name);
    bool same = x.data && y.data && eclat_picture_width(a) == eclat_picture_width(b) && eclat_picture_height(a) == eclat_picture_height(b);
    const size_t pixels = (size_t)eclat_picture_width(a) * eclat_picture_height(a);
    for (size_t i = 0; same && i < pixels; i++) same = x.data[i * x.stride] == y.data[i * y.stride];
    return same;
}

/* Runs the work with both standard streams redirected to a file, which must stay empty. */
static inline void check_silence(void (*work)(void), const char *path)
{
    FILE *printed = fopen(path, "w+");
    const int out = dup(STDOUT_FILENO), error = dup(STDERR_FILENO);
    if (!printed) exit(1);
    fflush(stdout);
    dup2(fileno(printed), STDOUT_FILENO);
    dup2(fileno(printed), STDERR_FILENO);
    work();
    fflush(NULL);
    const off_t size = lseek(fileno(printed), 0, SEEK_END);
    dup2(out, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    CHECK_MSG(size == 0, "%ld bytes were printed to %s", (long)size, path);
    fclose(printed);
}

#endif
