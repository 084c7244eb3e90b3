#define _GNU_SOURCE /* memfd_create */
#include "cl/compiler.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <spawn.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/module.h"

extern char **environ;

/* Returns a file in memory that holds states and jobs, positioned at its start. */
static int job_file(const ec_compile_job *const *jobs, uint32_t count)
{
    const int fd = memfd_create("eclat-compile", MFD_CLOEXEC), copy = fd >= 0 ? fcntl(fd, F_DUPFD_CLOEXEC, 0) : -1;
    FILE *to = copy >= 0 ? fdopen(copy, "w") : NULL;
    const ec_compile_states open = {.programs = {EC_COMPILE_OPEN}};
    bool good = to && fwrite(&open, sizeof open, 1, to) == 1;
    for (uint32_t i = 0; good && i < count; i++) good = ec_compile_job_write(jobs[i], to);
    if (to) fclose(to);
    else if (copy >= 0) close(copy);
    if (good && lseek(fd, 0, SEEK_SET) == 0) return fd;
    if (fd >= 0) close(fd);
    return -1;
}

/* Starts the program. The child leaves a grandchild behind and ends at once (host/compile/main.c), so that nobody has to wait for it later. */
static int spawn(const char *path, int job, int report)
{
    char *argv[] = {(char *)path, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child = -1;
    if (posix_spawn_file_actions_init(&actions)) return errno;
    int code = posix_spawn_file_actions_adddup2(&actions, job, STDIN_FILENO);
    if (!code) code = posix_spawn_file_actions_adddup2(&actions, report, STDOUT_FILENO);
    if (!code) code = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (!code) code = posix_spawn(&child, path, &actions, NULL, argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    while (!code && waitpid(child, NULL, 0) < 0 && errno == EINTR) {}
    return code;
}

ec_result ec_compiler_start(const ec_compile_job *const *jobs, uint32_t count, ec_compiler *compiler, ec_error *err)
{
    char path[PATH_MAX];
    int ends[2] = {-1, -1};
    *compiler = (ec_compiler){.report = -1, .count = jobs[0]->kernel_count};
    EC_TRY(ec_module_find("eclat-compile", path, err));
    const int file = job_file(jobs, count);
    if (file < 0) return ec_fail(err, "out of memory for a compile job");
    int code = pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0 ? spawn(path, file, ends[1]) : errno;
    if (!code) compiler->states = ec_compile_states_map(file);
    close(file);
    if (ends[1] >= 0) close(ends[1]);
    if (!code) compiler->report = ends[0];
    else if (ends[0] >= 0) close(ends[0]);
    return code ? ec_fail(err, "cannot start '%s': %s", path, strerror(code)) : EC_OK;
}

bool ec_compiler_has_ended(ec_compiler *compiler)
{
    char told[64];
    ssize_t size = -1;
    if (compiler->report < 0) return true;
    while ((size = read(compiler->report, told, sizeof told)) > 0)
        for (ssize_t i = 0; i < size; i++)
            if (told[i] == EC_COMPILED_ALL) compiler->is_whole = true;
            else compiler->compiled++;
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return compiler->is_whole;
    ec_compiler_leave(compiler);
    return true;
}

void ec_compiler_leave(ec_compiler *compiler)
{
    if (compiler->report >= 0) close(compiler->report);
    compiler->report = -1;
    ec_compile_states_unmap(compiler->states);
    compiler->states = NULL;
}
