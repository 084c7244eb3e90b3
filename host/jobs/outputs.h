/* The files that a command reads and writes: their kinds, and whether they may be written. */
#ifndef EC_JOBS_OUTPUTS_H
#define EC_JOBS_OUTPUTS_H

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "gltf/reader.h"
#include "image/formats.h"
#include "jobs/channel_list.h"

/* The files that a command reads: none of them may be an output. */
typedef struct ec_inputs {
    const char *scene;        /* also stands for all files that it names; NULL: none */
    const char *const *files; /* further files; may hold NULLs */
    int file_count;
    ec_scene_files of_scene;  /* owned; empty until a file is found that might be one of them */
} ec_inputs;

/* Tells whether the file at this path is one of them. */
bool ec_inputs_have(ec_inputs *inputs, const char *path);
void ec_inputs_free(ec_inputs *inputs);

enum { EC_OUTPUT_EXR, EC_OUTPUT_PIXELS, EC_OUTPUT_PNG = EC_OUTPUT_PIXELS + EC_FORMAT_PNG };

enum { EC_OUTPUTS_MAX = 16 };

typedef struct ec_output {
    uint32_t kind;       /* EC_OUTPUT_EXR, or EC_OUTPUT_PIXELS + a format */
    char path[PATH_MAX]; /* as given; absolute once it is written */
} ec_output;

typedef struct ec_outputs {
    ec_output file[EC_OUTPUTS_MAX];
    int count;
} ec_outputs;

const ec_format *ec_output_format(const ec_output *output); /* NULL: EXR */
bool ec_outputs_have_exr(const ec_outputs *outputs);

/* Adds a file of -o; its kind follows from the extension. Returns EC_USAGE for other kinds, too many files, or the same file twice. */
ec_result ec_outputs_add(ec_outputs *outputs, const char *path, ec_error *err);

/* Adds the outputs used without -o: the scene's base name with .exr and .png, in the current directory. */
ec_result ec_outputs_add_default(ec_outputs *outputs, const char *scene, ec_error *err);

/* Adds the scene's base name with this ending, such as ".%u-%u.exr", in the current directory. */
__attribute__((format(printf, 4, 5))) ec_result ec_outputs_add_named(ec_outputs *outputs, const char *scene, ec_error *err, const char *ending, ...);

/* Checks before any work that all outputs can be written, and that none would overwrite another or an input. */
ec_result ec_outputs_check(const ec_outputs *outputs, ec_inputs *inputs, ec_error *err);

/* Warns if a disk has less room than the files may need; does not fail, as nobody knows how well they will compress. */
void ec_outputs_check_room(const ec_outputs *outputs, uint64_t pixel_count, ec_channel_set channels, const ec_log *log);

/* Tell whether two paths lead to one existing file; or to one file that writing either would make. */
bool ec_same_file(const char *a, const char *b);
bool ec_same_target(const char *a, const char *b);

#endif
