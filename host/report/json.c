#include "report/json.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>

#include "base/freed.h"

void ec_json_real(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        cJSON_AddNumberToObject(object, key, value);
    else
        cJSON_AddNullToObject(object, key);
}

void ec_json_whole(cJSON *object, const char *key, uint64_t value)
{
    char digits[24]; /* cJSON's own numbers are doubles: 53 bits */
    snprintf(digits, sizeof digits, "%" PRIu64, value);
    cJSON_AddRawToObject(object, key, digits);
}

/* Returns the size of the well-formed UTF-8 sequence at s; 0: there is none (RFC 3629). */
static int utf8_size(const unsigned char *s)
{
    if (s[0] < 0x80) return 1;
    int size = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4) return 0;
    for (int i = 1; i < size; i++)
        if ((s[i] & 0xc0) != 0x80) return 0;
    if ((s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f)) return 0;
    if ((s[0] == 0xf0 && s[1] < 0x90) || (s[0] == 0xf4 && s[1] > 0x8f)) return 0;
    return size;
}

void ec_json_text(cJSON *object, const char *key, const char *value)
{
    EC_FREED char *clean = value ? strdup(value) : NULL;
    for (char *c = clean; c && *c;) {
        int size = utf8_size((unsigned char *)c);
        if (size == 0) *c = '?';
        c += size ? size : 1;
    }
    cJSON *text = clean ? cJSON_CreateString(clean) : cJSON_CreateNull();
    if (cJSON_IsArray(object)) cJSON_AddItemToArray(object, text);
    else cJSON_AddItemToObject(object, key, text);
}

void ec_json_add(cJSON *object, const ec_field *f)
{
    for (; f->key; f++) {
        switch (f->kind) {
        case EC_FIELD_NONE: cJSON_AddNullToObject(object, f->key); break;
        case EC_FIELD_REAL: ec_json_real(object, f->key, f->real); break;
        case EC_FIELD_WHOLE: ec_json_whole(object, f->key, f->whole); break;
        case EC_FIELD_TEXT: ec_json_text(object, f->key, f->text); break;
        case EC_FIELD_FLAG: cJSON_AddBoolToObject(object, f->key, f->whole != 0); break;
        }
    }
}

cJSON *ec_json_object(cJSON *in, const char *key)
{
    cJSON *object = cJSON_CreateObject();
    if (cJSON_IsArray(in)) cJSON_AddItemToArray(in, object);
    else cJSON_AddItemToObject(in, key, object);
    return object;
}

void ec_json_words(cJSON *object, const char *key, const char *words, char end)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    while (*(words += strspn(words, ", "))) {
        char word[128];
        int size = (int)strcspn(words, (const char[]){end, 0});
        snprintf(word, sizeof word, "%.*s", size, words);
        ec_json_text(array, NULL, word);
        words += size;
    }
}

void ec_json_texts(cJSON *object, const char *key, const char *const *texts, size_t count)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (size_t i = 0; i < count; i++) ec_json_text(array, NULL, texts[i]);
}

ec_result ec_json_print(cJSON *object, FILE *to, ec_error *err)
{
    char *text = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    if (!text) return ec_fail(err, "out of memory while writing the JSON report");
    errno = 0;
    bool lost = fprintf(to, "%s\n", text) < 0; /* stdio does not keep the reason of an earlier failure */
    int why = errno;
    cJSON_free(text);
    return lost ? ec_fail(err, "cannot write the result%s: %s", to == stdout ? " to standard output" : "", strerror(why)) : EC_OK;
}
