/* Options as tables: a row says how one is read, what help says of it, and who takes it. */
#ifndef EC_JOBS_OPTION_H
#define EC_JOBS_OPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Like ec_fail, but returns EC_USAGE: the command line is wrong. */
#define ec_usage(...) (ec_fail(__VA_ARGS__), EC_USAGE)

/* How a value is read, and the type of the field that keeps it. */
typedef enum ec_option_kind {
    EC_AS_NOTHING, /* who asks looks whether it was given */
    EC_AS_FLAG,    /* bool */
    EC_AS_TEXT,    /* const char *, not empty */
    EC_AS_WORD,    /* const char *, one of choices */
    EC_AS_CHOICE,  /* an enum in the order of choices */
    EC_AS_U32, EC_AS_REAL,                     /* from least to most; a double */
    EC_AS_U64,                                 /* any */
    EC_AS_SECONDS, EC_AS_PERCENT, EC_AS_BYTES, /* a double, a double, a uint64_t */
    EC_AS_TRIPLE,                              /* three doubles */
    EC_AS_SIZE,                                /* width and height, a uint32_t each */
    EC_AS_LANES,                               /* a uint32_t */
    EC_AS_FILE,                                /* const char *, named NAME.ending */
    EC_AS_OUTPUT,                              /* ec_outputs, one more of them */
    EC_AS_EXPOSURE,                            /* ec_exposure: stops from least to most, or auto */
} ec_option_kind;

/* Stores one option's value in a way of its own; `option` is its name, value NULL for a flag. */
typedef ec_result ec_option_setter(void *target, const char *option, const char *value, ec_error *err);

enum { EC_VALUE_OPTIONAL = 2 };

/* Where help lists it. */
typedef enum ec_option_group {
    EC_GROUP_OPTIONS, /* of commands with few of them */
    EC_GROUP_STUDY,
    EC_GROUP_SCENE,
    EC_GROUP_PICTURE,
    EC_GROUP_LIMITS,
    EC_GROUP_ANIMATION,
    EC_GROUP_SERIES,
    EC_GROUP_RESUME,
    EC_GROUP_TRANSPORT,
    EC_GROUP_DEVICE,
    EC_GROUP_MEASURE,
    EC_GROUP_RESULTS,
    EC_GROUP_MESSAGES,
    EC_GROUP_COUNT
} ec_option_group;

/* Who takes an option of `eclat render`, and what depends on it. */
enum {
    EC_OPTION_INFO = 1 << 0,         /* eclat info takes it too */
    EC_OPTION_COST = 1 << 1,         /* eclat cost takes it too */
    EC_OPTION_CAMERA = 1 << 2,       /* places the camera: eclat view drops it once the camera has moved */
    EC_OPTION_WINDOW = 1 << 3,       /* eclat view writes it anew in the command that repeats a picture, or leaves it out there */
    EC_OPTION_NO_IDENTITY = 1 << 4,  /* no frame depends on it, or its identity says it in other words */
    EC_OPTION_SEQUENCE = 1 << 5,     /* belongs to a sequence as a whole: a frame's own command has none, or another */
    EC_OPTION_KEEPING = 1 << 6,      /* of checkpoints: not in the command of a job that is resumed */
    EC_OPTION_PART = 1 << 7,         /* renders something other than one whole picture: does not go with --plan */
    EC_OPTION_REPEATS = 1 << 8,      /* every value counts, not the last one alone */
    EC_OPTION_BORROWED = 1 << 9,     /* a copy of render's in another command: help lists it briefly */
    EC_OPTION_LIMIT = 1 << 10,       /* ends a render: one given with --resume replaces all that there were */
    EC_OPTION_OUTPUT = 1 << 11,      /* and so do outputs */
};

typedef struct ec_option {
    const char *name;             /* without dashes */
    char letter;                  /* short form; 0 = none */
    const char *metavar;          /* what help calls its value; NULL: a flag */
    bool value_optional;          /* then after "=" alone, and NULL without */
    ec_option_kind kind;
    size_t at, told;              /* where the field is in the target; and a bool that becomes true, 0: none */
    double least, most;
    const char *ending;           /* ".exr" */
    ec_option_setter *set;        /* in place of kind; NULL: none */
    ec_option_group group;
    const char *help;             /* without line breaks */
    const char *otherwise;        /* the default; NULL: none, or help says it */
    const char *const *choices;   /* values, NULL-terminated; NULL: others too */
    uint32_t integrators;         /* bits by ec_integrator; 0: all */
    uint32_t uses;                /* EC_OPTION_* */
    const char *not_in_window;    /* why eclat view refuses it; NULL: it does not */
} ec_option;

/* false, true or EC_VALUE_OPTIONAL. */
int ec_option_takes_value(const ec_option *option);

/* NULL: none of them has this name. */
const ec_option *ec_options_find(const ec_option *options, int count, const char *name);

/* Stores a value as the row says. */
ec_result ec_option_store(const ec_option *option, void *target, const char *value, ec_error *err);

/* The type of each kind's field; another does not compile. GCC and Clang take enums for unsigned ints. */
#define EC_TYPE_FLAG bool
#define EC_TYPE_TEXT const char *
#define EC_TYPE_WORD const char *
#define EC_TYPE_FILE const char *
#define EC_TYPE_CHOICE unsigned
#define EC_TYPE_U32 uint32_t
#define EC_TYPE_SIZE uint32_t
#define EC_TYPE_LANES uint32_t
#define EC_TYPE_U64 uint64_t
#define EC_TYPE_BYTES uint64_t
#define EC_TYPE_REAL double
#define EC_TYPE_SECONDS double
#define EC_TYPE_PERCENT double
#define EC_TYPE_TRIPLE double *
#define EC_TYPE_OUTPUT ec_outputs
#define EC_TYPE_EXPOSURE ec_exposure
#define EC_HAS_TYPE(field, type) sizeof(char[_Generic((field), type: 1, default: -1)])

/* How a row stores its value in a field of REQUEST, a type that the file defines. */
#define EC_STORED(as, field) .kind = EC_AS_##as, .at = offsetof(REQUEST, field) + 0 * EC_HAS_TYPE(((REQUEST *)0)->field, EC_TYPE_##as)
#define EC_RANGED(as, field, from, to) EC_STORED(as, field), .least = from, .most = to
#define EC_CHOSEN(field, names) EC_STORED(CHOICE, field), .choices = names
#define EC_TOLD(field) .told = offsetof(REQUEST, field)

enum { EC_OPTIONS_MAX = 96 };

#endif
