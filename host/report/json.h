/* Helpers around cJSON that keep every number true: 64-bit integers exact, infinities and NaN null. */
#ifndef EC_REPORT_JSON_H
#define EC_REPORT_JSON_H

#include <cjson/cJSON.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

void ec_json_real(cJSON *object, const char *key, double value);
void ec_json_whole(cJSON *object, const char *key, uint64_t value);
void ec_json_text(cJSON *object, const char *key, const char *value); /* NULL: null; bytes that are not UTF-8 become ? */
void ec_json_words(cJSON *object, const char *key, const char *words, char end); /* an array; each ends by a comma, or by a blank */
void ec_json_texts(cJSON *object, const char *key, const char *const *texts, size_t count);

/* Prints the object on one line and deletes it. */
ec_result ec_json_print(cJSON *object, FILE *to, ec_error *err);

#endif
