#include "image/png_text.h"

#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { FIRST = 8 + 25, OF_CHUNK = 12 }; /* bytes of the signature and IHDR; of a chunk beside its data */

static void put_word(uint8_t *to, uint32_t word)
{
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(word >> (24 - 8 * i));
}

static uint32_t word_at(const uint8_t *at) { return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]; }

ec_result ec_png_add_text(uint8_t **bytes, size_t *size, const char *keyword, const char *text, ec_error *err)
{
    size_t name = strlen(keyword) + 1, data = name + 4 + strlen(text); /* not compressed, no language, no translated keyword */
    uint8_t *grown = realloc(*bytes, *size + data + OF_CHUNK);
    if (!grown) return ec_fail(err, "out of memory for a PNG");
    *bytes = grown;
    uint8_t *chunk = grown + FIRST;
    memmove(chunk + data + OF_CHUNK, chunk, *size - FIRST);
    *size += data + OF_CHUNK;
    put_word(chunk, (uint32_t)data);
    memcpy(chunk + 4, "iTXt", 4);
    memset(chunk + 8, 0, data);
    memcpy(chunk + 8, keyword, name);
    memcpy(chunk + 8 + name + 4, text, data - name - 4);
    put_word(chunk + 8 + data, (uint32_t)crc32(0, chunk + 4, (uInt)(4 + data)));
    return EC_OK;
}

static char *find(const uint8_t *bytes, size_t size, const char *keyword)
{
    static const uint8_t end[OF_CHUNK] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    size_t name = strlen(keyword) + 1;
    if (size < FIRST + OF_CHUNK || png_sig_cmp(bytes, 0, 8) || memcmp(bytes + size - OF_CHUNK, end, OF_CHUNK)) return NULL;
    for (size_t at = 8; size - at > OF_CHUNK;) {
        size_t data = word_at(bytes + at);
        const uint8_t *chunk = bytes + at + 8;
        if (data > size - at - OF_CHUNK) return NULL;
        bool is_it = !memcmp(chunk - 4, "iTXt", 4) && data >= name + 4 && !memcmp(chunk, keyword, name);
        if (is_it) return strndup((const char *)chunk + name + 4, data - name - 4);
        at += data + OF_CHUNK;
    }
    return NULL;
}

char *ec_png_whole_text(const char *path, const char *keyword)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    if (!file) return NULL;
    long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    uint8_t *bytes = size > 0 ? malloc((size_t)size) : NULL;
    if (bytes && fseek(file, 0, SEEK_SET) == 0 && fread(bytes, 1, (size_t)size, file) == (size_t)size) text = find(bytes, (size_t)size, keyword);
    free(bytes);
    fclose(file);
    return text;
}
