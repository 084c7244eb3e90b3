#include "view/texture_upload.h"

#include <epoxy/gl.h>

static void map(ec_view_slot *slot, unsigned buffer)
{
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, (GLsizeiptr)slot->capacity, NULL, GL_STREAM_DRAW);
    slot->bytes = glMapBuffer(GL_PIXEL_UNPACK_BUFFER, GL_WRITE_ONLY);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    slot->state = slot->bytes ? EC_UPLOAD_FREE : EC_UPLOAD_AWAY;
}

static void unmap(ec_view_slot *slot, unsigned buffer)
{
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    if (slot->bytes) glUnmapBuffer(GL_PIXEL_UNPACK_BUFFER);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    slot->bytes = NULL;
    slot->state = EC_UPLOAD_AWAY;
}

ec_result ec_view_textures_make(ec_view_textures *t, ec_error *err)
{
    *t = (ec_view_textures){0};
    if (epoxy_gl_version() < 21)
        return ec_fail(err, "the preview window needs OpenGL 2.1; this display has %s", (const char *)glGetString(GL_VERSION));
    int largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    t->largest = (uint32_t)(largest > 0 ? largest : 1024);
    glGenTextures(EC_ROLE_COUNT, t->texture);
    glGenBuffers(EC_VIEW_SLOTS, t->buffer);
    for (int i = 0; i < EC_ROLE_COUNT; i++) {
        glBindTexture(GL_TEXTURE_2D, t->texture[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST); /* a sample is a square, and a pixel is what it is */
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    return EC_OK;
}

/* The renderer takes slots under the lock only, so what is free here stays so. */
void ec_view_textures_fit(ec_view_textures *t, ec_view *view, size_t bytes)
{
    bool any = false;
    pthread_mutex_lock(&view->lock);
    for (int i = 0; i < EC_VIEW_SLOTS; i++) {
        ec_view_slot *slot = &view->slots[i];
        if (slot->capacity == bytes || slot->state == EC_UPLOAD_WRITING || slot->state == EC_UPLOAD_READY) continue;
        unmap(slot, t->buffer[i]);
        slot->capacity = bytes;
        map(slot, t->buffer[i]);
        any = true;
    }
    if (any) ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

static void upload(ec_view_textures *t, const ec_view_slot *slot, unsigned buffer)
{
    uint32_t role = slot->role;
    GLsizei width = (GLsizei)slot->width, height = (GLsizei)slot->height;
    glBindTexture(GL_TEXTURE_2D, t->texture[role]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glUnmapBuffer(GL_PIXEL_UNPACK_BUFFER);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (t->width[role] == slot->width && t->height[role] == slot->height)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, NULL);
    else
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, NULL);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    t->width[role] = slot->width;
    t->height[role] = slot->height;
}

bool ec_view_textures_take(ec_view_textures *t, ec_view *view)
{
    bool any = false;
    pthread_mutex_lock(&view->lock);
    for (uint32_t role = 0; role < EC_ROLE_COUNT; role++) {
        int newest = -1;
        for (int i = 0; i < EC_VIEW_SLOTS; i++) {
            const ec_view_slot *slot = &view->slots[i];
            if (slot->state != EC_UPLOAD_READY || slot->role != role) continue;
            if (newest < 0 || slot->serial > view->slots[newest].serial) newest = i;
        }
        for (int i = 0; i < EC_VIEW_SLOTS && newest >= 0; i++) {
            ec_view_slot *slot = &view->slots[i];
            if (slot->state != EC_UPLOAD_READY || slot->role != role) continue;
            if (i == newest) upload(t, slot, t->buffer[i]);
            if (i == newest) map(slot, t->buffer[i]);
            else slot->state = EC_UPLOAD_FREE;
            any = true;
        }
    }
    if (any) ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    return any;
}

void ec_view_textures_draw(const ec_view_textures *t, uint32_t role, double x0, double x1, double height, double u0, double u1)
{
    if (!t->width[role]) return;
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, t->texture[role]);
    glColor4f(1, 1, 1, 1);
    glBegin(GL_QUADS);
    glTexCoord2d(u0, 1), glVertex2d(x0, 0);
    glTexCoord2d(u1, 1), glVertex2d(x1, 0);
    glTexCoord2d(u1, 0), glVertex2d(x1, height);
    glTexCoord2d(u0, 0), glVertex2d(x0, height);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

void ec_view_textures_free(ec_view_textures *t, ec_view *view)
{
    for (int i = 0; i < EC_VIEW_SLOTS; i++) unmap(&view->slots[i], t->buffer[i]);
    glDeleteBuffers(EC_VIEW_SLOTS, t->buffer);
    glDeleteTextures(EC_ROLE_COUNT, t->texture);
}
