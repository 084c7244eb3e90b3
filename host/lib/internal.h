/* Types and functions shared by the implementation of eclat.h. */
#ifndef EC_LIB_INTERNAL_H
#define EC_LIB_INTERNAL_H

#include <stdatomic.h>

#include "commands/command.h"
#include "eclat/eclat.h"

struct eclat_job {
    const ec_command *command;
    ec_option rows[EC_OPTIONS_MAX]; /* those of the command */
    int row_count;
    ec_given_options given;     /* owned, like the fields below */
    char **inputs;
    int input_count;
    void *checked;              /* a request with these options, so that an invalid one is reported when it is set */
    char *program, *line;       /* as typed; NULL: it was not typed */
    eclat_listener listener;
    ec_ranks *ranks;            /* not owned */
    atomic_int is_stopped;
    atomic_int wakes;           /* a descriptor for commands that wait for events, readable once they have to stop; -1: none */
    bool says_no;
};

/* A picture that was rendered, merged or mixed. */
struct eclat_picture {
    ec_call call;             /* the call that made it, with its results */
    char *line;               /* the command that makes it again; owned */
    ec_picture planes;        /* of a rendered picture */
    ec_channel_list channels;
    ec_report_attributes attributes;
    ec_film_error error;
    double samples_per_pixel;
    uint32_t replicates;
    char why[2048];
};

/* Fills in a caller's error, which may be NULL. */
eclat_result ec_lib_end(ec_result result, const ec_error *from, eclat_error *to);

/* Appends a copy of a text to a list of texts. */
ec_result ec_lib_add_text(char ***list, int *count, const char *text, ec_error *err);

/* Passes everything on to a caller's listener. What it points to must last. */
typedef struct ec_lib_ear {
    const eclat_listener *listener;
    atomic_int *is_stopped;   /* set once the listener asks to stop; NULL: it cannot stop */
    bool is_quiet;            /* only warnings and failures are passed on */
    bool says_once;           /* notes and warnings are not repeated */
    uint64_t said[64];        /* hashes of those said */
    int said_count;
    FILE *to;                 /* stream of a report, whose text and size are valid after a flush. Owned by whoever made the ear */
    char *text;
    size_t size;
    const ec_render_options *options; /* of the current render */
    bool has_predicted;        /* the forecast was passed on */
} ec_lib_ear;
ec_listener ec_lib_listener(ec_lib_ear *ear);

/* Runs the command "view". */
ec_result ec_lib_view(eclat_job *job, const ec_call *call, ec_error *err);

/* Sets planes, channels, attributes and error from what was rendered, merged or mixed. */
ec_result ec_lib_picture_finish(eclat_picture *picture, ec_error *err);

#endif
