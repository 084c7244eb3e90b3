#include "store/identity_text.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

char *ec_identity_write(const ec_identity *identity)
{
    cJSON *object = cJSON_CreateObject();
    for (uint32_t i = 0; i < identity->count; i++)
        cJSON_AddStringToObject(object, identity->traits[i].name, identity->traits[i].value);
    char *text = cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    return text;
}

bool ec_identity_read(const char *text, ec_identity *identity)
{
    cJSON *item, *object = cJSON_Parse(text);
    bool is_sound = cJSON_IsObject(object);
    memset(identity, 0, sizeof *identity);
    cJSON_ArrayForEach(item, object) {
        is_sound = is_sound && item->string && cJSON_IsString(item) && identity->count < EC_TRAITS_MAX;
        if (!is_sound) break;
        ec_trait *trait = &identity->traits[identity->count++];
        snprintf(trait->name, sizeof trait->name, "%s", item->string);
        snprintf(trait->value, sizeof trait->value, "%s", item->valuestring);
    }
    cJSON_Delete(object);
    return is_sound;
}
