#include "jobs/option.h"

#include <string.h>

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
