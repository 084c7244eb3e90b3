#include <stdio.h>
#include <string.h>

#include "live/shared.h"

void ec_live_post(ec_live *live)
{
    live->events++;
    pthread_cond_broadcast(&live->changed);
}

void ec_live_tell(ec_live *live)
{
    ec_live_post(live);
    if (live->hears.wake) live->hears.wake(live->hears.user);
}

void ec_live_say_trouble(ec_live *live, eclat_trouble whose, const char *text, bool is_final)
{
    char *said = live->status.trouble[whose];
    pthread_mutex_lock(&live->lock);
    bool is_other = strcmp(said, text) != 0;
    if (is_final) live->status.has_failed = 1 + (int)whose;
    snprintf(said, sizeof live->status.trouble[whose], "%s", text);
    if (is_other || is_final) ec_live_tell(live);
    pthread_mutex_unlock(&live->lock);
}
