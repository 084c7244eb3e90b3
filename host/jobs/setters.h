/* Setters of options, each an ec_option_set, in a line where they need no more. A file that includes this says what REQUEST is:
 *
 *     #define REQUEST ((ec_render_request *)target)
 *
 * and EC_SHARED_SETTERS, if others use its setters too: ec_set_NAME then, not set_NAME. */
#ifndef EC_JOBS_SETTERS_H
#define EC_JOBS_SETTERS_H

#include "jobs/numbers.h"
#include "jobs/usage.h"

#ifdef EC_SHARED_SETTERS
#define SETTER(name) ec_result ec_set_##name(void *target, const char *option, const char *value, ec_error *err)
#else
#define SETTER(name) static ec_result set_##name(void *target, const char *option, const char *value, ec_error *err)
#endif

#define FLAG_SETTER(name, field)                                                                    \
    SETTER(name)                                                                                    \
    {                                                                                               \
        (void)option, (void)value, (void)err;                                                       \
        REQUEST->field = true;                                                                      \
        return EC_OK;                                                                               \
    }

#define TEXT_SETTER(name, field)                                                                    \
    SETTER(name)                                                                                    \
    {                                                                                               \
        if (!*value) return ec_usage(err, "option '--%s' needs a value that is not empty", option); \
        REQUEST->field = value;                                                                     \
        return EC_OK;                                                                               \
    }

/* One of names, which NULL ends, into an enum of the same order. */
#define CHOICE_SETTER(name, field, type, names)                                                     \
    SETTER(name)                                                                                    \
    {                                                                                               \
        uint32_t index = 0;                                                                         \
        EC_TRY(ec_parse_choice(option, value, names, &index, err));                                 \
        REQUEST->field = (type)index;                                                               \
        return EC_OK;                                                                               \
    }

/* By a function of numbers.h. */
#define PARSED_SETTER(name, parse, field) \
    SETTER(name) { return parse(option, value, &REQUEST->field, err); }
#define RANGE_SETTER(name, parse, least, most, field) \
    SETTER(name) { return parse(option, value, least, most, &REQUEST->field, err); }

#endif
