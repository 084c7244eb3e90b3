#include "store/rare_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char list[] = "rarePaths";

/* Adds a kind; its tiles take two hexadecimal digits each. */
static void add_kind(cJSON *array, const ec_rare_kind *kind)
{
    char share[2 * EC_RARE_SHARES + 1];
    cJSON *one = cJSON_CreateObject();
    for (int i = 0; i < EC_RARE_SHARES; i++) snprintf(share + 2 * i, 3, "%02x", kind->share[i]);
    cJSON_AddStringToObject(one, "through", kind->through);
    cJSON_AddStringToObject(one, "light", kind->light);
    cJSON_AddNumberToObject(one, "chance", kind->chance);
    cJSON_AddNumberToObject(one, "luminance", kind->luminance);
    cJSON_AddBoolToObject(one, "isRelative", kind->is_relative);
    cJSON_AddNumberToObject(one, "clamped", kind->clamped);
    cJSON_AddNumberToObject(one, "gathered", kind->gathered);
    cJSON_AddStringToObject(one, "share", share);
    cJSON_AddNumberToObject(one, "peak", kind->peak);
    cJSON_AddItemToArray(array, one);
}

void ec_rare_state_add(cJSON *state, const ec_rare *rare)
{
    cJSON *array = cJSON_AddArrayToObject(state, list); /* the picture's size is the film's */
    for (uint32_t i = 0; rare && i < rare->count; i++) add_kind(array, &rare->kinds[i]);
}

static bool read_name(const cJSON *one, const char *key, char name[EC_RARE_NAME])
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(one, key);
    if (!cJSON_IsString(item) || strlen(item->valuestring) >= EC_RARE_NAME) return false;
    snprintf(name, EC_RARE_NAME, "%s", item->valuestring);
    return true;
}

static bool read_number(const cJSON *one, const char *key, double *number)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(one, key);
    *number = cJSON_IsNumber(item) ? item->valuedouble : -1;
    return *number >= 0 && isfinite(*number);
}

static bool read_flag(const cJSON *one, const char *key, bool *flag)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(one, key);
    *flag = cJSON_IsTrue(item);
    return cJSON_IsBool(item);
}

static bool read_share(const cJSON *one, uint8_t share[EC_RARE_SHARES])
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(one, "share");
    if (!cJSON_IsString(item) || strlen(item->valuestring) != 2 * EC_RARE_SHARES) return false;
    for (int i = 0; i < EC_RARE_SHARES; i++) {
        unsigned value;
        if (sscanf(item->valuestring + 2 * i, "%2x", &value) != 1) return false;
        share[i] = (uint8_t)value;
    }
    return true;
}

bool ec_rare_state_read(const cJSON *state, ec_rare *rare)
{
    const cJSON *one, *array = cJSON_GetObjectItemCaseSensitive(state, list);
    bool reads = cJSON_IsArray(array) && cJSON_GetArraySize(array) <= EC_RARE_KINDS;
    *rare = (ec_rare){0};
    if (!reads) return false;
    cJSON_ArrayForEach(one, array) {
        ec_rare_kind *kind = &rare->kinds[rare->count++];
        reads &= read_flag(one, "isRelative", &kind->is_relative) && read_number(one, "peak", &kind->peak) && read_name(one, "through", kind->through) && read_name(one, "light", kind->light) && read_number(one, "chance", &kind->chance) &&
                 read_number(one, "luminance", &kind->luminance) && read_number(one, "clamped", &kind->clamped) && read_number(one, "gathered", &kind->gathered) && read_share(one, kind->share);
    }
    return reads;
}
