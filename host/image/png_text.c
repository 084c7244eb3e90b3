/* Reads the text under a keyword of a PNG. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

typedef struct reading {
    char *text;
    uint8_t *row;
    bool is_whole;
} reading;

static void leave(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp message) { (void)png, (void)message; }

static char *text_under(png_structp png, png_infop info, const char *keyword)
{
    png_textp texts = NULL;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; i++)
        if (!strcmp(texts[i].key, keyword)) return strdup(texts[i].text);
    return NULL;
}

/* Reads to the very end, so that damage is found; rows are decoded one by one into `row`, which has the largest width. */
static void read_all(png_structp png, png_infop info, FILE *file, const char *keyword, reading *r)
{
    if (setjmp(png_jmpbuf(png))) return;
    png_init_io(png, file);
    png_read_info(png, info);
    r->text = text_under(png, info, keyword);
    if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) return;
    r->row = malloc(png_get_rowbytes(png, info));
    for (png_uint_32 y = 0; r->row && y < png_get_image_height(png, info); y++) png_read_row(png, r->row, NULL);
    if (r->row) png_read_end(png, info);
    r->is_whole = r->row;
}

char *ec_png_text_of(const char *path, const char *keyword, bool *is_whole)
{
    *is_whole = false;
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, leave, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    reading r = {0};
    if (info) read_all(png, info, file, keyword, &r);
    png_destroy_read_struct(&png, &info, NULL);
    free(r.row);
    fclose(file);
    *is_whole = r.is_whole;
    return r.text;
}
