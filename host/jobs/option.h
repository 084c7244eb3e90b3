/* Tables of options: a row says how an option is read, how help describes it, and which commands take it. */
#ifndef EC_JOBS_OPTION_H
#define EC_JOBS_OPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Like ec_fail, but returns EC_USAGE: an option or argument is wrong. */
#define ec_usage(...) (ec_fail(__VA_ARGS__), EC_USAGE)

/* How a value is read, and the type of the field that stores it. */
typedef enum ec_option_kind {
    EC_AS_NOTHING, /* not stored: callers ask whether it was given */
    EC_AS_FLAG,    /* bool */
    EC_AS_TEXT,    /* const char *, not empty */
    EC_AS_WORD,    /* const char *, one of `choices` */
    EC_AS_CHOICE,  /* an enum in the order of `choices` */
    EC_AS_U32, EC_AS_REAL,                     /* uint32_t and double, from `least` to `most` */
    EC_AS_U64,                                 /* uint64_t, any value */
    EC_AS_SECONDS, EC_AS_PERCENT, EC_AS_BYTES, /* double, double, uint64_t */
    EC_AS_TRIPLE,                              /* three doubles */
    EC_AS_SIZE,                                /* width and height, two uint32_t */
    EC_AS_LANES,                               /* a uint32_t */
    EC_AS_FILE,                                /* const char *, a name that ends in `ending` */
    EC_AS_OUTPUT,                              /* ec_outputs, to which it is added */
    EC_AS_EXPOSURE,                            /* ec_exposure: stops from `least` to `most`, or auto */
} ec_option_kind;

/* Stores an option's value in its own way; value is NULL for a flag. */
typedef ec_result ec_option_setter(void *target, const char *option, const char *value, ec_error *err);

enum { EC_VALUE_OPTIONAL = 2 };

/* The section of help that lists it. */
typedef enum ec_option_group {
    EC_GROUP_OPTIONS, /* for commands with few options */
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

/* Which commands take an option of `eclat render`, and what depends on it. */
enum {
    EC_OPTION_INFO = 1 << 0,         /* eclat info takes it too */
    EC_OPTION_COST = 1 << 1,         /* eclat cost takes it too */
    EC_OPTION_CAMERA = 1 << 2,       /* places the camera: eclat view drops it from commands once the camera has moved */
    EC_OPTION_WINDOW = 1 << 3,       /* eclat view replaces it in, or drops it from, the command that repeats a picture */
    EC_OPTION_NO_IDENTITY = 1 << 4,  /* no frame depends on it, or the frame's identity has it in another form */
    EC_OPTION_SEQUENCE = 1 << 5,     /* belongs to a sequence as a whole: the command of one frame has none, or another value */
    EC_OPTION_KEEPING = 1 << 6,      /* about checkpoints: not part of the command of a job that is resumed */
    EC_OPTION_PART = 1 << 7,         /* renders something other than one whole picture: cannot be combined with --plan */
    EC_OPTION_REPEATS = 1 << 8,      /* all values count, not only the last one */
    EC_OPTION_BORROWED = 1 << 9,     /* copied from render into another command: help lists it briefly */
    EC_OPTION_LIMIT = 1 << 10,       /* ends a render: one given with --resume replaces all previous ones */
    EC_OPTION_OUTPUT = 1 << 11,      /* likewise for outputs */
};

typedef struct ec_option {
    const char *name;             /* without dashes */
    char letter;                  /* short form; 0 = none */
    const char *metavar;          /* name of the value in help; NULL: a flag */
    bool value_optional;          /* the value can only be given after "=", and is NULL otherwise */
    ec_option_kind kind;
    size_t at, told;              /* offsets in the target: of the field, and of a bool that is set to true (0: none) */
    double least, most;
    const char *ending;           /* ".exr" */
    ec_option_setter *set;        /* replaces kind; NULL: not used */
    ec_option_group group;
    const char *help;             /* without line breaks */
    const char *otherwise;        /* the default; NULL: none, or stated in help */
    const char *const *choices;   /* allowed values, ended by NULL; NULL: others are allowed too */
    uint32_t integrators;         /* bits by ec_integrator; 0: all */
    uint32_t uses;                /* EC_OPTION_* */
    const char *not_in_window;    /* why eclat view refuses it; NULL: it is accepted */
} ec_option;

/* Returns false, true or EC_VALUE_OPTIONAL. */
int ec_option_takes_value(const ec_option *option);

/* Returns NULL if no option has this name. */
const ec_option *ec_options_find(const ec_option *options, int count, const char *name);

/* Stores a value as the row demands. */
ec_result ec_option_store(const ec_option *option, void *target, const char *value, ec_error *err);

/* Types of the fields of each kind; a field of another type does not compile. GCC and Clang treat enums as unsigned ints. */
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

/* Initialise how a row stores its value in a field of REQUEST, a type that the file defines. */
#define EC_STORED(as, field) .kind = EC_AS_##as, .at = offsetof(REQUEST, field) + 0 * EC_HAS_TYPE(((REQUEST *)0)->field, EC_TYPE_##as)
#define EC_RANGED(as, field, from, to) EC_STORED(as, field), .least = from, .most = to
#define EC_CHOSEN(field, names) EC_STORED(CHOICE, field), .choices = names
#define EC_TOLD(field) .told = offsetof(REQUEST, field)

enum { EC_OPTIONS_MAX = 96 };

#endif
