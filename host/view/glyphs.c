#include "view/glyphs.h"

#include <epoxy/gl.h>
#include <stdbool.h>
#include <stdlib.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>
#pragma GCC diagnostic pop

#include "view/view.h"

extern const unsigned char ec_bytes_font[]; /* made by tools/embed_bytes.py */

enum { FIRST = 32, COUNT = 95, ATLAS_MOST = 2048 };

struct ec_view_glyphs {
    stbtt_packedchar packed[COUNT];
    int atlas;
};

static bool pack(ec_view_text *t, unsigned char *pixels, int atlas, double size)
{
    stbtt_pack_context context;
    if (!stbtt_PackBegin(&context, pixels, atlas, atlas, 0, 1, NULL)) return false;
    int fits = stbtt_PackFontRange(&context, ec_bytes_font, 0, (float)size, FIRST, COUNT, t->glyphs->packed);
    stbtt_PackEnd(&context);
    return fits;
}

static void upload(ec_view_text *t, const unsigned char *pixels)
{
    int atlas = t->glyphs->atlas;
    glGenTextures(1, &t->texture);
    glBindTexture(GL_TEXTURE_2D, t->texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA, atlas, atlas, 0, GL_ALPHA, GL_UNSIGNED_BYTE, pixels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

eclat_result ec_view_text_make(ec_view_text *t, double size, eclat_error *err)
{
    stbtt_fontinfo font;
    int ascent, descent, gap;
    *t = (ec_view_text){.glyphs = malloc(sizeof *t->glyphs)};
    unsigned char *pixels = malloc((size_t)ATLAS_MOST * ATLAS_MOST);
    bool fits = t->glyphs && pixels && stbtt_InitFont(&font, ec_bytes_font, 0);
    for (int atlas = 256; fits && !t->size && atlas <= ATLAS_MOST; atlas *= 2)
        if (pack(t, pixels, atlas, size)) t->glyphs->atlas = atlas, t->size = size;
    if (t->size > 0) {
        stbtt_GetFontVMetrics(&font, &ascent, &descent, &gap);
        double scale = (double)stbtt_ScaleForPixelHeight(&font, (float)size);
        t->ascent = scale * ascent;
        t->line = 1.15 * size;
        t->advance = (double)t->glyphs->packed[0].xadvance;
        upload(t, pixels);
    }
    free(pixels);
    if (t->size > 0) return ECLAT_OK;
    ec_view_text_free(t);
    return ec_view_fail(err, "no text of %g pixels for the preview window", size);
}

void ec_view_text_free(ec_view_text *t)
{
    if (t->texture) glDeleteTextures(1, &t->texture);
    free(t->glyphs);
    *t = (ec_view_text){0};
}

void ec_view_text_draw(const ec_view_text *t, double x, double y, double right, const char *line, const float rgb[3])
{
    float pen = (float)(int)x, down = 0; /* stb's y points down from the base line */
    double base = (double)(int)(y - t->ascent);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, t->texture);
    glColor3fv(rgb);
    glBegin(GL_QUADS);
    for (const unsigned char *c = (const unsigned char *)line; *c && (double)pen + t->advance <= right; c++) {
        stbtt_aligned_quad q;
        if ((*c & 0xc0) == 0x80) continue; /* continuation byte of a UTF-8 character */
        int glyph = *c >= FIRST && *c < FIRST + COUNT ? *c - FIRST : '?' - FIRST;
        stbtt_GetPackedQuad(t->glyphs->packed, t->glyphs->atlas, t->glyphs->atlas, glyph, &pen, &down, &q, 1);
        glTexCoord2f(q.s0, q.t0), glVertex2d((double)q.x0, base - (double)q.y0);
        glTexCoord2f(q.s1, q.t0), glVertex2d((double)q.x1, base - (double)q.y0);
        glTexCoord2f(q.s1, q.t1), glVertex2d((double)q.x1, base - (double)q.y1);
        glTexCoord2f(q.s0, q.t1), glVertex2d((double)q.x0, base - (double)q.y1);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

void ec_view_veil(double x0, double y0, double x1, double y1)
{
    glColor4f(0, 0, 0, 0.72f);
    glBegin(GL_QUADS);
    glVertex2d(x0, y0), glVertex2d(x1, y0), glVertex2d(x1, y1), glVertex2d(x0, y1);
    glEnd();
}
