/* Pictures into mapped pixel buffers: what the tone mapper writes is what the graphics card reads. */
#include "base/clock.h"
#include "view/shared.h"

static ec_view_slot *take_free_slot(ec_view *view, size_t bytes)
{
    for (int i = 0; i < EC_VIEW_SLOTS; i++) {
        ec_view_slot *slot = &view->slots[i];
        if (slot->state != EC_UPLOAD_FREE || slot->capacity < bytes) continue;
        slot->state = EC_UPLOAD_WRITING;
        return slot;
    }
    return NULL;
}

bool ec_view_show_filled(ec_view *view, uint32_t role, uint32_t width, uint32_t height, ec_view_fill fill, const void *user)
{
    pthread_mutex_lock(&view->lock);
    ec_view_slot *slot = take_free_slot(view, (size_t)width * height * 3);
    pthread_mutex_unlock(&view->lock);
    if (!slot) return false;
    fill(user, slot->bytes);
    pthread_mutex_lock(&view->lock);
    slot->width = width;
    slot->height = height;
    slot->role = role;
    slot->serial = ++view->picture_serial;
    slot->state = EC_UPLOAD_READY;
    view->status.pictures += role == EC_ROLE_PICTURE;
    if (view->status.first_light == 0) view->status.first_light = ec_now() - view->start;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    return true;
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

bool ec_view_show(ec_view *view, const ec_view_wish *wish, uint32_t role, const float *rgb, uint32_t width, uint32_t height)
{
    const toned t = {rgb, (uint64_t)width * height, (float)wish->exposure, wish->tonemap};
    return ec_view_show_filled(view, role, width, height, fill_toned, &t);
}
