#include "view/texture_upload.h"

#include <epoxy/gl.h>

#include "view/view.h"

eclat_result ec_view_textures_make(ec_view_textures *t, eclat_error *err)
{
    *t = (ec_view_textures){0};
    if (epoxy_gl_version() < 21)
        return ec_view_fail(err, "the preview window needs OpenGL 2.1; this display has %s", (const char *)glGetString(GL_VERSION));
    int largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    t->largest = (uint32_t)(largest > 0 ? largest : 1024);
    glGenTextures(ECLAT_SHOWN_COUNT, t->texture);
    glGenBuffers(1, &t->buffer);
    for (int i = 0; i < ECLAT_SHOWN_COUNT; i++) {
        glBindTexture(GL_TEXTURE_2D, t->texture[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST); /* pixels and samples are shown as squares, not smoothed */
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    return ECLAT_OK;
}

void ec_view_textures_free(ec_view_textures *t)
{
    glDeleteBuffers(1, &t->buffer);
    glDeleteTextures(ECLAT_SHOWN_COUNT, t->texture);
}

/* Uploads through a buffer, from which the graphics card copies while the window goes on. */
static void upload(ec_view_textures *t, eclat_shown which, const eclat_image *image)
{
    GLsizei width = (GLsizei)image->width, height = (GLsizei)image->height;
    glBindTexture(GL_TEXTURE_2D, t->texture[which]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, t->buffer);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, (GLsizeiptr)width * height * 3, image->rgb, GL_STREAM_DRAW);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (t->width[which] == image->width && t->height[which] == image->height)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, NULL);
    else
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, NULL);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    t->width[which] = image->width;
    t->height[which] = image->height;
}

bool ec_view_textures_take(ec_view_textures *t, eclat_live *live)
{
    bool any = false;
    for (eclat_shown which = 0; which < ECLAT_SHOWN_COUNT; which++) {
        eclat_image image;
        if (!eclat_live_take(live, which, &image)) continue;
        upload(t, which, &image);
        any = true;
    }
    return any;
}

void ec_view_textures_draw(const ec_view_textures *t, eclat_shown which, double x0, double x1, double height, double u0, double u1)
{
    if (!t->width[which]) return;
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, t->texture[which]);
    glColor4f(1, 1, 1, 1);
    glBegin(GL_QUADS);
    glTexCoord2d(u0, 1), glVertex2d(x0, 0);
    glTexCoord2d(u1, 1), glVertex2d(x1, 0);
    glTexCoord2d(u1, 0), glVertex2d(x1, height);
    glTexCoord2d(u0, 0), glVertex2d(x0, height);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}
