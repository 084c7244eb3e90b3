/* Opens and closes a window ten times in one process, under ASan, LSan and UBSan, which report anything that a window leaves behind.
 *
 * Usage: ten_windows SCENE SCRIPT PICTURE.exr. test_view.py runs it. */
#include <stdio.h>

#include "view/view.h"

static void print(void *user, const char *text)
{
    (void)user;
    fputs(text, stdout);
}

static bool is_true(void *user) { return *(bool *)user; }

int main(int argc, char **argv)
{
    eclat_error err = {0};
    eclat_job *job = NULL;
    if (argc != 4 || eclat_job_new("render", &job, &err) || eclat_job_add(job, argv[1], &err)) return fprintf(stderr, "%s\n", err.text), 1;
    const char *const options[][2] = {{"size", "64x48"}, {"spp", "4"}, {"replicates", "2"}, {"lanes", "4"}, {"output", argv[3]}};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (eclat_job_set(job, options[i][0], options[i][1], &err)) return fprintf(stderr, "%s\n", err.text), 1;
    bool stops = false;
    ec_view_request request = {.job = job, .script = argv[2], .report = print, .user = &stops, .should_stop = is_true};
    for (int i = 0; i < 10; i++)
        if (ec_module.run(&request, &err)) return fprintf(stderr, "window %d: %s\n", i, err.text), 1;
    /* A window without a script would stay open: it must also stop if that was asked for before it opened. */
    stops = true;
    request.script = NULL;
    if (ec_module.run(&request, &err)) return fprintf(stderr, "a window that is to stop: %s\n", err.text), 1;
    eclat_job_free(job);
    puts("ten windows");
    return 0;
}
