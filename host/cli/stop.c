#include "cli/stop.h"

#include <signal.h>
#include <stddef.h>

/* The one thing a handler may touch; a signal has no other way to carry a context. */
static volatile sig_atomic_t requested;

static void on_signal(int signal_number)
{
    if (requested) {
        signal(signal_number, SIG_DFL);
        raise(signal_number); /* delivered as soon as this handler returns */
        return;
    }
    requested = 1;
}

void ec_stop_catch_signals(void)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++) {
        struct sigaction old;
        if (sigaction(signals[i], NULL, &old) == 0 && old.sa_handler == SIG_IGN) continue;
        sigaction(signals[i], &action, NULL);
    }
}

bool ec_stop_requested(void)
{
    return requested != 0;
}
