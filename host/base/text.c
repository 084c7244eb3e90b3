#include "base/text.h"

#include <stdlib.h>
#include <string.h>

#include "base/freed.h"

static int length_from(unsigned char first)
{
    return first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1;
}

int ec_text_cut(const char *text, int most)
{
    int end = (int)strnlen(text, (size_t)most), first = end;
    do first--;
    while (first > 0 && end - first < 4 && ((unsigned char)text[first] & 0xc0) == 0x80);
    return end && first + length_from((unsigned char)text[first]) > end ? first : end;
}

/* Returns the bytes of a character that must not reach a terminal; 0: it may. U+0080 to U+009F are controls; U+200E, U+200F, U+202A to U+202E and
 * U+2066 to U+2069 change the direction of writing; U+2028 and U+2029 break lines. */
static int unsafe_length(const unsigned char *c)
{
    if (*c < 32 || *c == 127) return *c == '\t' || (*c == '\n' && c[1] == ' ' && c[2] == ' ') ? 0 : 1;
    if (*c == 0xc2) return c[1] >= 0x80 && c[1] <= 0x9f ? 2 : 0;
    if (*c != 0xe2) return 0;
    if (c[1] == 0x80) return c[2] == 0x8e || c[2] == 0x8f || (c[2] >= 0xa8 && c[2] <= 0xae) ? 3 : 0;
    return c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9 ? 3 : 0;
}

void ec_text_clean(char *text)
{
    unsigned char *to = (unsigned char *)text;
    for (const unsigned char *c = to; *c;) {
        const int length = unsafe_length(c);
        *to++ = length ? '?' : *c;
        c += length ? length : 1;
    }
    *to = 0;
}

void ec_text_print(FILE *to, const char *before, const char *name, const char *behind)
{
    EC_FREED char *copy = strdup(name);
    if (!copy) return;
    ec_text_clean(copy);
    fprintf(to, "%s%s%s", before, copy, behind);
}
