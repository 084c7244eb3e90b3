/* The pictures of a job that renders several: each with the scene and options of a command that would render it alone. */
#ifndef EC_JOBS_ENTRIES_H
#define EC_JOBS_ENTRIES_H

#include "jobs/render_request.h"

typedef struct ec_entry {
    char *name;              /* in messages. Owned, as all of it */
    char *scene;             /* file */
    ec_given_options given;  /* with outputs of its own; those of the whole job, as --sheet, are left out */
    char *why_not;           /* it cannot be rendered, or has failed; NULL: neither */
} ec_entry;

/* Zero-initialised: none. */
typedef struct ec_entries {
    ec_entry *list; /* owned */
    uint32_t count;
} ec_entries;

/* Adds one without options. EC_FAILED: no memory. */
ec_result ec_entries_add(ec_entries *entries, const char *name, const char *scene, ec_entry **entry, ec_error *err);

/* Each scene with the same options: in outputs {name} becomes its file's name without the ending, {folder} the name of the folder that holds it.
 * EC_USAGE where several scenes would share an output, or an option belongs to one picture. */
ec_result ec_entries_of_scenes(char *const *scenes, int count, const ec_given_options *given, ec_entries *entries, ec_error *err);

/* Copies options, but for outputs and what is of the whole job. */
ec_result ec_entry_give(ec_entry *entry, const ec_given_options *given, ec_error *err);

/* EC_USAGE where an option belongs to one picture. */
ec_result ec_entries_check(const ec_given_options *given, ec_error *err);

/* Has the name of an output a place that is filled by scene? */
bool ec_entries_has_place(const char *output);

void ec_entries_free(ec_entries *entries);

#endif
