/* Runs the command "view": gives the window, a client of the public header in a module, a job and the functions by which it reports to the listener. */
#include <poll.h>
#include <pthread.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "base/module.h"
#include "commands/command.h"
#include "lib/internal.h"
#include "view/view.h"

static ec_result load(const ec_view_module **module, ec_error *err)
{
    const void *symbol = NULL;
    EC_TRY(ec_module_load("view", "this eclat has no preview window; install the package eclat-view, or build eclat with libglfw3-dev, "
                                  "libepoxy-dev, libstb-dev and fonts-dejavu-core; 'eclat render' needs none of them", &symbol, err));
    *module = symbol;
    return EC_OK;
}

eclat_note eclat_view_key_at(size_t i)
{
    const ec_view_module *window;
    eclat_note key = {.heading = "Keys and mouse"};
    return load(&window, NULL) == EC_OK && window->key_at(i, &key.term, &key.text) ? key : (eclat_note){0};
}

/* Makes the job that the window shows, with the options that `render` has too. */
static eclat_result make_job(const eclat_job *view, const char *scene, eclat_job **job, eclat_error *err)
{
    eclat_result result = eclat_job_new("render", job, err);
    if (result == ECLAT_OK) result = eclat_job_add(*job, scene, err);
    for (int i = 0; result == ECLAT_OK && i < view->given.count; i++) {
        const ec_option *row = ec_render_row(view->given.list[i].option);
        if (row) result = eclat_job_set(*job, row->name, view->given.list[i].value, err);
    }
    if (result == ECLAT_OK) eclat_job_listen(*job, &view->listener);
    return result;
}

/* Wakes the window when the job has to stop. */
typedef struct stopper {
    const ec_view_module *window;
    int stop, end; /* descriptors; stop: that of the job; end: readable when there is nothing left to stop */
} stopper;

static void *wait_for_stop(void *user)
{
    const stopper *s = user;
    struct pollfd files[2] = {{.fd = s->stop, .events = POLLIN}, {.fd = s->end, .events = POLLIN}};
    while (poll(files, 2, -1) < 0) {}
    if (files[0].revents) s->window->wake();
    return NULL;
}

static void report(void *user, const char *text)
{
    const ec_listener *listener = user;
    fputs(text, listener->to);
    listener->report(listener->user, NULL);
}

static bool should_stop(void *user)
{
    const ec_listener *listener = user;
    return listener->should_stop(listener->user);
}

ec_result ec_lib_view(eclat_job *job, const ec_call *call, ec_error *err)
{
    const ec_view_options *options = call->request;
    stopper s = {.stop = call->stop, .end = eventfd(0, EFD_CLOEXEC)};
    const char *scene;
    eclat_job *shown = NULL;
    eclat_error why = {0};
    pthread_t thread;
    ec_result result;
    EC_TRY_CLEANUP(ec_call_scene(call, "view", &scene, err));
    EC_TRY_CLEANUP(load(&s.window, err));
    call->listener->begin(call->listener->user, NULL, false);
    const bool may_stop = s.end >= 0 && pthread_create(&thread, NULL, wait_for_stop, &s) == 0;
    result = (ec_result)make_job(job, scene, &shown, &why);
    const ec_view_request request = {.job = shown, .against = options->against, .script = options->script, .stats = options->stats,
                                     .user = (void *)(uintptr_t)call->listener, .report = report, .should_stop = should_stop};
    if (result == EC_OK) result = (ec_result)s.window->run(&request, &why);
    if (may_stop) {
        eventfd_write(s.end, 1);
        pthread_join(thread, NULL);
    }
    eclat_job_free(shown);
    if (result != EC_OK) ec_fail(err, "%s", why.text);
cleanup:
    if (s.end >= 0) close(s.end);
    return result;
}
