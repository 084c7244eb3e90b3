/* Passes pictures and messages to the caller. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "live/shared.h"

void ec_live_wake(ec_live *live)
{
    live->events++;
    pthread_cond_broadcast(&live->changed);
}

void ec_live_tell(ec_live *live)
{
    ec_live_wake(live);
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

ec_result ec_live_canvas(ec_live *live, eclat_shown which, uint32_t width, uint32_t height, uint8_t **rgb, ec_error *err)
{
    ec_live_image *image = &live->shown[which].written;
    const uint64_t bytes = (uint64_t)width * height * 3;
    if (image->room < bytes) {
        free(image->rgb);
        *image = (ec_live_image){.rgb = malloc(bytes)};
        if (!image->rgb) return ec_fail(err, "out of memory for a picture of %ux%u pixels", width, height);
        image->room = bytes;
    }
    image->width = width;
    image->height = height;
    *rgb = image->rgb;
    return EC_OK;
}

void ec_live_hand_out(ec_live *live, eclat_shown which)
{
    ec_live_shown *shown = &live->shown[which];
    pthread_mutex_lock(&live->lock);
    const ec_live_image ready = shown->written;
    shown->written = shown->ready;
    shown->ready = ready;
    shown->is_new = true;
    live->status.pictures += which == ECLAT_PICTURE;
    if (live->status.first_light == 0) live->status.first_light = ec_now() - live->start;
    ec_live_tell(live);
    pthread_mutex_unlock(&live->lock);
}

ec_result ec_live_show(ec_live *live, const eclat_view_request *view, eclat_shown which, const float *rgb, uint32_t width, uint32_t height, ec_error *err)
{
    uint8_t *bytes;
    EC_TRY(ec_live_canvas(live, which, width, height, &bytes, err));
    ec_tonemap_rgb(rgb, bytes, (uint64_t)width * height, (float)view->exposure, (ec_tonemap)view->tonemap);
    ec_live_hand_out(live, which);
    return EC_OK;
}
