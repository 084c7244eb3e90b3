/* The pictures of a job that renders several, each with the scene and options of the command that would render it alone. */
#ifndef EC_JOBS_ENTRIES_H
#define EC_JOBS_ENTRIES_H

#include "jobs/render_request.h"

typedef struct ec_entry {
    char *name;              /* for messages. Owned, like all fields */
    char *scene;             /* path */
    ec_given_options given;  /* including its outputs; without options of the whole job, such as --sheet */
    char *why_not;           /* why it cannot be rendered, or has failed; NULL: neither */
} ec_entry;

/* Zero-initialised: none. */
typedef struct ec_entries {
    ec_entry *list; /* owned */
    uint32_t count;
} ec_entries;

/* Adds an entry without options. Returns EC_FAILED if there is no memory. */
ec_result ec_entries_add(ec_entries *entries, const char *name, const char *scene, ec_entry **entry, ec_error *err);

/* Makes an entry of each scene, with the same options. In outputs, {name} becomes the scene's file name without the ending, {folder} the name of its
 * folder. Returns EC_USAGE if several scenes would share an output, or an option belongs to a single picture. */
ec_result ec_entries_of_scenes(char *const *scenes, int count, const ec_given_options *given, ec_entries *entries, ec_error *err);

/* Copies all options but outputs and those of the whole job. */
ec_result ec_entry_give(ec_entry *entry, const ec_given_options *given, ec_error *err);

/* Returns EC_USAGE if an option belongs to a single picture. */
ec_result ec_entries_check(const ec_given_options *given, ec_error *err);

/* Tells whether an output's name has a placeholder that depends on the scene. */
bool ec_entries_has_place(const char *output);

void ec_entries_free(ec_entries *entries);

#endif
