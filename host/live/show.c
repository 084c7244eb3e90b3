/* Pictures for the caller. */
#include <stdlib.h>

#include "base/clock.h"
#include "live/shared.h"

ec_result ec_live_show_filled(ec_live *live, eclat_shown which, uint32_t width, uint32_t height, ec_live_fill fill, const void *user, ec_error *err)
{
    ec_live_shown *shown = &live->shown[which];
    ec_live_image *image = &shown->written;
    const uint64_t bytes = (uint64_t)width * height * 3;
    if (image->room < bytes) {
        free(image->rgb);
        *image = (ec_live_image){.rgb = malloc(bytes)};
        if (!image->rgb) return ec_fail(err, "out of memory for a picture of %ux%u pixels", width, height);
        image->room = bytes;
    }
    fill(user, image->rgb);
    image->width = width;
    image->height = height;
    pthread_mutex_lock(&live->lock);
    const ec_live_image ready = *image;
    *image = shown->ready;
    shown->ready = ready;
    shown->is_new = true;
    live->status.pictures += which == ECLAT_PICTURE;
    if (live->status.first_light == 0) live->status.first_light = ec_now() - live->start;
    ec_live_tell(live);
    pthread_mutex_unlock(&live->lock);
    return EC_OK;
}

typedef struct toned {
    const float *rgb;
    uint64_t pixels;
    float exposure;
    ec_tonemap tonemap;
} toned;

static void fill_toned(const void *user, uint8_t *bytes)
{
    const toned *t = user;
    ec_tonemap_rgb(t->rgb, bytes, t->pixels, t->exposure, t->tonemap);
}

ec_result ec_live_show(ec_live *live, const eclat_wish *wish, eclat_shown which, const float *rgb, uint32_t width, uint32_t height, ec_error *err)
{
    const toned t = {rgb, (uint64_t)width * height, (float)wish->exposure, (ec_tonemap)wish->tonemap};
    return ec_live_show_filled(live, which, width, height, fill_toned, &t, err);
}
