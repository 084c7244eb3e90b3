#include "jobs/option.h"

#include <string.h>
#include <strings.h>

#include "film/exposure.h"
#include "jobs/numbers.h"
#include "jobs/outputs.h"

int ec_option_takes_value(const ec_option *option)
{
    return option->value_optional ? EC_VALUE_OPTIONAL : option->metavar != NULL;
}

const ec_option *ec_options_find(const ec_option *options, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(options[i].name, name)) return &options[i];
    return NULL;
}

static ec_result store_choice(const ec_option *o, void *field, const char *value, ec_error *err)
{
    uint32_t index = 0; /* as large as EC_TYPE_CHOICE */
    EC_TRY(ec_parse_choice(o->name, value, o->choices, &index, err));
    if (o->kind == EC_AS_WORD) *(const char **)field = o->choices[index];
    else memcpy(field, &index, sizeof index);
    return EC_OK;
}

/* Stores the path of a checkpoint or the like, an EXR whose name must say so, since viewers go by that. */
static ec_result store_file(const ec_option *o, const char **field, const char *value, ec_error *err)
{
    const size_t size = strlen(value), ending = strlen(o->ending);
    if (size <= ending || value[size - ending - 1] == '/' || strcasecmp(value + size - ending, o->ending))
        return ec_usage(err, "--%s: '%s' must be named NAME%s", o->name, value, o->ending);
    *field = value;
    return EC_OK;
}

static ec_result store_exposure(const ec_option *o, ec_exposure *field, const char *value, ec_error *err)
{
    *field = (ec_exposure){.is_auto = !strcmp(value, "auto")};
    if (field->is_auto || ec_parse_real(o->name, value, o->least, o->most, &field->stops, NULL) == EC_OK) return EC_OK;
    return ec_usage(err, "--%s: '%s' is neither a number from %g to %g nor auto", o->name, value, o->least, o->most);
}

ec_result ec_option_store(const ec_option *o, void *target, const char *value, ec_error *err)
{
    void *field = (char *)target + o->at;
    if (o->set) return o->set(target, o->name, value, err);
    if (o->told) *(bool *)((char *)target + o->told) = true;
    switch (o->kind) {
    case EC_AS_NOTHING: return EC_OK;
    case EC_AS_FLAG: *(bool *)field = true; return EC_OK;
    case EC_AS_TEXT:
        if (!*value) return ec_usage(err, "option '--%s' needs a value that is not empty", o->name);
        *(const char **)field = value;
        return EC_OK;
    case EC_AS_WORD:
    case EC_AS_CHOICE: return store_choice(o, field, value, err);
    case EC_AS_U32: return ec_parse_u32(o->name, value, (uint32_t)o->least, (uint32_t)o->most, field, err);
    case EC_AS_U64: return ec_parse_whole(o->name, value, 0, UINT64_MAX, field, err);
    case EC_AS_REAL: return ec_parse_real(o->name, value, o->least, o->most, field, err);
    case EC_AS_SECONDS: return ec_parse_seconds(o->name, value, field, err);
    case EC_AS_PERCENT: return ec_parse_percent(o->name, value, field, err);
    case EC_AS_BYTES: return ec_parse_bytes(o->name, value, field, err);
    case EC_AS_TRIPLE: return ec_parse_triple(o->name, value, field, err);
    case EC_AS_SIZE: return ec_parse_size(o->name, value, field, (uint32_t *)field + 1, err);
    case EC_AS_FILE: return store_file(o, field, value, err);
    case EC_AS_EXPOSURE: return store_exposure(o, field, value, err);
    case EC_AS_OUTPUT: return ec_outputs_add(field, value, err);
    case EC_AS_LANES: return ec_parse_lanes(o->name, value, field, err);
    }
    return EC_OK;
}
