#include "base/text.h"

#include <string.h>

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
