/* The files that a command reads: none of them may be what it writes. */
#ifndef EC_JOBS_INPUTS_H
#define EC_JOBS_INPUTS_H

#include <stdbool.h>

#include "gltf/reader.h"

typedef struct ec_inputs {
    const char *scene;        /* and all files that it names; NULL: none */
    const char *const *files; /* beside it; may hold NULLs */
    int file_count;
    ec_scene_files of_scene;  /* owned; empty until a file is found that might be one of them */
} ec_inputs;

/* Is the file at this path one of them? */
bool ec_inputs_have(ec_inputs *inputs, const char *path);
void ec_inputs_free(ec_inputs *inputs);

/* Do two paths lead to one file that exists? */
bool ec_same_file(const char *a, const char *b);

#endif
