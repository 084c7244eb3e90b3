/* The text that a PNG keeps under a keyword. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

static void leave(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp message) { (void)png, (void)message; }

/* To the very end, so that a file that is cut short is known; rows are decoded one by one into `row`, as wide as they may be. */
static char *read_all(png_structp png, png_infop info, FILE *file, uint8_t *volatile *row, const char *keyword)
{
    png_textp texts = NULL;
    int count = 0;
    if (setjmp(png_jmpbuf(png))) return NULL;
    png_init_io(png, file);
    png_read_info(png, info);
    if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) return NULL;
    *row = malloc(png_get_rowbytes(png, info));
    for (png_uint_32 y = 0; *row && y < png_get_image_height(png, info); y++) png_read_row(png, *row, NULL);
    if (!*row) return NULL;
    png_read_end(png, info);
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; i++)
        if (!strcmp(texts[i].key, keyword)) return strdup(texts[i].text);
    return NULL;
}

char *ec_png_whole_text(const char *path, const char *keyword)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, leave, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    uint8_t *volatile row = NULL;
    char *text = info ? read_all(png, info, file, &row, keyword) : NULL;
    png_destroy_read_struct(&png, &info, NULL);
    free(row);
    fclose(file);
    return text;
}
