/* Types and functions that the functions of eclat.h share. */
#ifndef EC_LIB_INTERNAL_H
#define EC_LIB_INTERNAL_H

#include <stdatomic.h>

#include "commands/command.h"
#include "eclat/eclat.h"

struct eclat_job {
    const ec_command *command;
    ec_option rows[EC_OPTIONS_MAX]; /* of the command */
    int row_count;
    ec_given_options given;     /* owned, as all that follows */
    char **inputs;
    int input_count;
    void *checked;              /* a request with these options, so that a wrong one is told when it is set */
    char *program, *line;       /* as typed; NULL: it was not */
    eclat_listener listener;
    ec_ranks *ranks;            /* not owned */
    atomic_int is_stopped;
    atomic_int wakes;           /* a descriptor for commands that wait, readable once they are to stop; -1: none */
    bool says_no;
};

/* A picture is rendered, merged or mixed. */
struct eclat_picture {
    ec_call call;             /* that made it, with what it left */
    char *line;               /* the command that makes the same; owned */
    ec_picture planes;        /* of what was rendered */
    ec_channel_list channels;
    ec_report_attributes attributes;
    ec_film_error error;
    double samples_per_pixel;
    uint32_t replicates;
    char why[2048];
};

/* Fills in a caller's error, which may be NULL. */
eclat_result ec_lib_end(ec_result result, const ec_error *from, eclat_error *to);

/* A text at the end of a list of texts. */
ec_result ec_lib_add_text(char ***list, int *count, const char *text, ec_error *err);

/* A listener that passes all on to a caller's; what it points to must last. */
typedef struct ec_lib_ear {
    const eclat_listener *listener;
    atomic_int *is_stopped;   /* set once the listener wants so; NULL: nothing stops */
    bool is_quiet;            /* warnings and failures alone are passed on */
    bool says_once;           /* what was said: notes and warnings */
    uint64_t said[64];        /* their hashes */
    int said_count;
    FILE *to;                 /* a report, and its text once it is flushed. Owned by who made the ear */
    char *text;
    size_t size;
    const ec_render_options *options; /* of the render that is under way */
    bool has_foretold;        /* what it will take */
} ec_lib_ear;
ec_listener ec_lib_listener(ec_lib_ear *ear);

/* Runs the command "view". */
ec_result ec_lib_view(eclat_job *job, const ec_call *call, ec_error *err);

/* Takes planes, channels, attributes and error from what was rendered, merged or mixed. */
ec_result ec_lib_picture_finish(eclat_picture *picture, ec_error *err);

#endif
