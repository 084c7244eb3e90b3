/* Helpers around cJSON that preserve every number: 64-bit integers are exact, infinities and NaN null. */
#ifndef EC_REPORT_JSON_H
#define EC_REPORT_JSON_H

#include <cjson/cJSON.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* Fields of an object, any number of which are added at once: EC_JSON(object, EC_REAL("seconds", s), EC_FLAG("failed", f)). */
typedef struct ec_field {
    const char *key;
    enum { EC_FIELD_NONE, EC_FIELD_REAL, EC_FIELD_WHOLE, EC_FIELD_TEXT, EC_FIELD_FLAG } kind; /* EC_FIELD_NONE: null */
    double real;      /* infinite or NaN: null */
    uint64_t whole;   /* for a flag: 0 or 1 */
    const char *text; /* NULL: null */
} ec_field;
#define EC_REAL(name, value) {.key = name, .kind = EC_FIELD_REAL, .real = (double)(value)}
#define EC_WHOLE(name, value) {.key = name, .kind = EC_FIELD_WHOLE, .whole = value}
#define EC_STRING(name, value) {.key = name, .kind = EC_FIELD_TEXT, .text = value}
#define EC_FLAG(name, value) {.key = name, .kind = EC_FIELD_FLAG, .whole = value}
#define EC_JSON(object, ...) ec_json_add(object, (const ec_field[]){__VA_ARGS__, {0}})
void ec_json_add(cJSON *object, const ec_field *fields); /* ended by a NULL key */

/* Adds an object under a key of an object, or at the end of an array (key NULL), and returns it. */
cJSON *ec_json_object(cJSON *in, const char *key);

void ec_json_real(cJSON *object, const char *key, double value);
void ec_json_whole(cJSON *object, const char *key, uint64_t value);
void ec_json_text(cJSON *object, const char *key, const char *value); /* NULL becomes null; bytes that are not UTF-8 become ? */
void ec_json_words(cJSON *object, const char *key, const char *words, char end); /* an array of the words, each ended by `end`, a comma or a blank */
void ec_json_texts(cJSON *object, const char *key, const char *const *texts, size_t count);

/* Prints the object on one line and deletes it. */
ec_result ec_json_print(cJSON *object, FILE *to, ec_error *err);

#endif
