/* The commands: what each is called, takes and does. */
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

/* A command that runs. */
typedef struct ec_call {
    /* Given. */
    const ec_listener *listener;
    ec_given_options given;     /* owned, as the inputs are */
    char **inputs;
    int input_count;
    void *request;              /* of the command's own type, with all options set; owned */
    bool is_given[EC_OPTIONS_MAX]; /* by its rows */
    bool json, quiet;           /* two options that most have */
    ec_words words;             /* the command, made of these; owned */
    const char *program, *line; /* as it was called */
    ec_ranks *ranks;            /* the other processes of an MPI job; NULL: there are none */
    bool wants_picture;         /* in memory: files are for the asking */
    int stop;                   /* a descriptor, readable once the command is to end; -1: none */
    /* Left by the command, the first four if a picture is wanted and there is one. Owned. */
    ec_render_job render;       /* its film */
    ec_merged merged;           /* or its picture, */
    ec_mix mix;                 /* or that of layers weighed anew */
    ec_result (*write)(struct ec_call *call, ec_outputs *outputs, ec_error *err);
    char folder[PATH_MAX];      /* in which it began */
    bool says_no;
} ec_call;

typedef struct ec_command {
    eclat_command told;
    int (*rows)(ec_option rows[EC_OPTIONS_MAX]); /* its options, those borrowed from `render` included; returns the number */
    size_t size;                /* of its request; 0: it has none */
    void (*start)(void *request); /* fills that with defaults; NULL: they are all 0 */
    ec_result (*run)(ec_call *call, ec_error *err); /* NULL: the library does it */
    bool is_shared;             /* by all ranks, where there are any */
    bool is_interactive;        /* it waits for a descriptor */
} ec_command;

/* The request of `view`. */
typedef struct ec_view_options {
    ec_render_request render; /* first: its options are stored in it, to refuse values at once */
    const char *against, *script;
    bool stats;
} ec_view_options;

extern const ec_command ec_cmd_compare, ec_cmd_cost, ec_cmd_devices, ec_cmd_info, ec_cmd_merge, ec_cmd_mix, ec_cmd_render, ec_cmd_selftest, ec_cmd_view;
extern const ec_command *const ec_commands[]; /* by name; NULL ends them */
extern const char *const ec_group_titles[EC_GROUP_COUNT];

const ec_command *ec_command_find(const char *name); /* NULL: there is none */

/* Its one input SCENE. */
ec_result ec_call_scene(const ec_call *call, const char *command, const char **scene, ec_error *err);

void ec_call_free(ec_call *call);

/* For tables of rows that never change. */
#define EC_ROWS(options)                                                   \
    static int list_rows(ec_option rows[EC_OPTIONS_MAX])                   \
    {                                                                      \
        memcpy(rows, options, sizeof options);                             \
        return sizeof options / sizeof options[0];                         \
    }

/* Titles that notes refer to. */
#define EC_TITLE_LIMITS "When to stop: at the first limit that is reached (default: --spp " EC_TEXT(EC_DEFAULT_SPP) ")"
#define EC_TITLE_RESUME "Resume and distribute"

#endif
