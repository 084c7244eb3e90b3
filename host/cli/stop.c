#include "cli/stop.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>

#include "cli/seconds.h"

/* Global, since signals belong to the process. */
enum { ENDS, CATCHES, TELLS };
static atomic_int manner = ENDS;
static atomic_bool requested;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* guards job and hint, so that neither is freed meanwhile */
static eclat_job *running;
static const char *hint;

static void end(int signal_number)
{
    sigset_t one;
    sigemptyset(&one);
    sigaddset(&one, signal_number);
    signal(signal_number, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &one, NULL);
    raise(signal_number);
}

#define ONE_WISH 0.5 /* seconds: schedulers and launchers signal both a job's script and its processes, and the script may pass its signal on */

static void *watch(void *signals)
{
    double first = 0;
    for (int number; sigwait(signals, &number) == 0;) {
        if (number == SIGQUIT || number == SIGUSR1) end(number);
        const bool again = atomic_load(&requested);
        if (atomic_load(&manner) == ENDS || (again && ec_seconds() - first > ONE_WISH)) end(number);
        if (again) continue;
        first = ec_seconds();
        atomic_store(&requested, true);
        pthread_mutex_lock(&lock);
        if (running) eclat_job_stop(running);
        if (hint) fprintf(stderr, "eclat: %s\n", hint);
        pthread_mutex_unlock(&lock);
        if (atomic_load(&manner) == TELLS)
            fputs("\neclat: stopping as soon as the device answers; once more quits at once\n", stderr);
    }
    return NULL;
}

void ec_stop_watch_signals(void)
{
    /* The last two end the process as usual; without this thread, drivers' compilers would swallow them. */
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1};
    static sigset_t signals; /* used by the thread as long as it lives */
    sigemptyset(&signals);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct sigaction old;
        if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN) sigaddset(&signals, numbers[i]);
    }
    pthread_t thread;
    pthread_sigmask(SIG_BLOCK, &signals, NULL);
    if (pthread_create(&thread, NULL, watch, &signals) == 0) pthread_detach(thread);
    else pthread_sigmask(SIG_UNBLOCK, &signals, NULL); /* they end the process as usual */
}

void ec_stop_ignore_file_size(void) { signal(SIGXFSZ, SIG_IGN); }

void ec_stop_catch_signals(bool tell)
{
    atomic_store(&manner, tell ? TELLS : CATCHES);
}

void ec_stop_job(eclat_job *job)
{
    pthread_mutex_lock(&lock);
    running = job;
    if (job && atomic_load(&requested)) eclat_job_stop(job);
    pthread_mutex_unlock(&lock);
}

void ec_stop_hint(const char *line)
{
    pthread_mutex_lock(&lock);
    hint = line;
    pthread_mutex_unlock(&lock);
}
