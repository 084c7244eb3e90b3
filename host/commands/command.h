/* The commands: their names, options and functions. */
#ifndef EC_COMMANDS_COMMAND_H
#define EC_COMMANDS_COMMAND_H

#include <limits.h>
#include <string.h>

#include "eclat/eclat.h"
#include "jobs/defaults.h"
#include "jobs/given.h"
#include "jobs/listener.h"
#include "jobs/merge_job.h"
#include "jobs/mix_job.h"
#include "jobs/render_job.h"
#include "jobs/option.h"

/* A run of a command. */
typedef struct ec_call {
    /* Set by the caller. */
    const ec_listener *listener;
    ec_given_options given;     /* owned, like the inputs */
    char **inputs;
    int input_count;
    void *request;              /* of the command's own type, with all options stored; owned */
    bool is_given[EC_OPTIONS_MAX]; /* by row of the command */
    bool json, quiet;           /* two options that most have */
    ec_words words;             /* the command made of these as words; owned */
    const char *program, *line; /* as it was called */
    ec_ranks *ranks;            /* the other processes of an MPI job; NULL: none */
    bool wants_picture;         /* in memory; files are written only if outputs are given */
    int stop;                   /* a descriptor that is readable once the command has to end; -1: none */
    /* Set by the command; the first four if a picture is wanted and there is one. Owned. */
    ec_render_job render;       /* with its film, */
    ec_merged merged;           /* or a merged picture, */
    ec_mix mix;                 /* or one with weighted layers */
    ec_result (*write)(struct ec_call *call, ec_outputs *outputs, ec_error *err);
    char folder[PATH_MAX];      /* in which the command began */
    bool says_no;
} ec_call;

typedef struct ec_command {
    eclat_command told;
    int (*rows)(ec_option rows[EC_OPTIONS_MAX]); /* fills in its options, including those borrowed from `render`; returns their number */
    size_t size;                /* of its request; 0: none */
    void (*start)(void *request); /* sets defaults; NULL: all are 0 */
    ec_result (*run)(ec_call *call, ec_error *err); /* NULL: run by the library */
    bool is_shared;             /* shared among all ranks, if there are any */
    bool is_interactive;        /* waits for events, and for `stop` */
} ec_command;

/* The request of `view`. */
typedef struct ec_view_options {
    ec_render_request render; /* must be first: its options are stored in it, so that invalid values are refused at once */
    const char *against, *script;
    bool stats;
} ec_view_options;

extern const ec_command ec_cmd_compare, ec_cmd_cost, ec_cmd_devices, ec_cmd_info, ec_cmd_merge, ec_cmd_mix, ec_cmd_render, ec_cmd_selftest, ec_cmd_view;
extern const ec_command *const ec_commands[]; /* in the order of names; ended by NULL */
extern const char *const ec_group_titles[EC_GROUP_COUNT];

const ec_command *ec_command_find(const char *name); /* NULL: there is none */

/* Gets the only input, SCENE. */
ec_result ec_call_scene(const ec_call *call, const char *command, const char **scene, ec_error *err);

void ec_call_free(ec_call *call);

/* Defines list_rows for a constant table of rows. */
#define EC_ROWS(options)                                                   \
    static int list_rows(ec_option rows[EC_OPTIONS_MAX])                   \
    {                                                                      \
        memcpy(rows, options, sizeof options);                             \
        return sizeof options / sizeof options[0];                         \
    }

/* Titles to which notes refer. */
#define EC_TITLE_LIMITS "When to stop: at the first limit that is reached (default: --spp " EC_TEXT(EC_DEFAULT_SPP) ")"
#define EC_TITLE_RESUME "Resume and distribute"

#endif
