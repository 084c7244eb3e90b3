/* libeclat: renders glTF 2.0 scenes to physically based images with a stated error, on any OpenCL device.
 *
 *     eclat_job *job = NULL;
 *     eclat_picture *picture = NULL;
 *     eclat_error err;
 *     if (eclat_job_new("render", &job, &err) || eclat_job_add(job, "scene.glb", &err) || eclat_job_set(job, "error", "2%", &err) ||
 *         eclat_job_run(job, &picture, &err) || eclat_picture_write(picture, "scene.exr", &err))
 *         fprintf(stderr, "%s\n", err.text);
 *     eclat_picture_free(picture);
 *     eclat_job_free(job);
 *
 * Errors. Functions that can fail return an eclat_result and fill an eclat_error (which may be NULL) with one line: what went wrong, where, and how
 * to mend it. Unless stated otherwise, the pointer to what they were to create is NULL then.
 * Ownership. The caller frees what _new, _list, _join, _open and _run create with the _free, _leave or _close of its type, which accepts NULL too.
 * Inputs are copied unless stated otherwise. Texts and arrays returned as const belong to the object that was asked, and are valid as long as it
 * is; those of tables are valid for ever.
 * Threads. Objects are independent of one another: each may be used by one thread at a time. Only eclat_job_stop may be called at any time from any
 * thread or from a signal handler, while the job exists. A job uses all cores, or the device that its options name. The library has no global state,
 * prints nothing and installs no signal handler; an OpenCL driver may. If the driver has no compiled kernels for a render yet, the render starts the
 * program eclat-compile, which may outlive it by some seconds; the option compile with the value "first" avoids that.
 * Texts are UTF-8; numbers in option values use a decimal point. */
#ifndef ECLAT_ECLAT_H
#define ECLAT_ECLAT_H

#include <stddef.h>
#include <stdint.h>

#define EC_VERSION_MAJOR 0
#define EC_VERSION_MINOR 1
#define EC_VERSION_PATCH 0
#define EC_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns EC_VERSION of the running library; its first number is that of the SONAME. */
const char *eclat_version(void);

/* A term and its explanation. */
typedef struct eclat_note {
    const char *heading; /* title of the group of options that the note belongs to, or a title of its own */
    const char *term, *text;
} eclat_note;

/* Returns item i, from 0, of how the library was built and what it has: compiler, OpenCL version, readers of compressed scenes, installed modules.
 * term is NULL beyond the last. */
eclat_note eclat_build_at(size_t i);

typedef enum eclat_result {
    ECLAT_OK = 0,
    ECLAT_FAILED = 1, /* a file, a device or memory failed, or the job was stopped before there was a picture */
    ECLAT_USAGE = 2   /* an option or an argument is wrong */
} eclat_result;

typedef enum eclat_error_kind { ECLAT_ERROR_OTHER, ECLAT_ERROR_HOST_MEMORY, ECLAT_ERROR_DEVICE_MEMORY, ECLAT_ERROR_DEVICE } eclat_error_kind;

typedef struct eclat_error {
    char text[2048]; /* one line, without a newline */
    eclat_error_kind kind;
} eclat_error;

/* ---- Devices ---- */

typedef struct eclat_device {
    const char *name, *vendor, *driver, *platform;
    uint64_t memory_bytes;
    uint32_t compute_units;
    int is_usable; /* it is available and has a compiler */
} eclat_device;

/* Lists all OpenCL devices in the order in which the option "device" numbers them, and sets *count. Texts belong to the list. */
eclat_result eclat_devices_list(eclat_device **devices, size_t *count, eclat_error *err);
void eclat_devices_free(eclat_device *devices);

/* ---- Commands: the kinds of jobs, and their options ---- */

typedef struct eclat_command {
    const char *name;                /* "render" */
    const char *operands;            /* what follows the name: "SCENE [options]" */
    const char *summary;             /* one line: what it does */
    const char *intro, *closing;     /* paragraphs before and after the list of options; closing NULL: none */
    const char *borrows;             /* heading of the options borrowed from render, listed by name only; NULL: these are described like its own */
    const char *lacks;               /* heading of the options of render that it refuses; NULL: it refuses none */
    const eclat_note *notes;         /* ended by a NULL heading; NULL: none */
} eclat_command;

typedef struct eclat_option {
    const char *name;                /* "spp" */
    char letter;                     /* short form on a command line; 0: none */
    int takes_value;                 /* 0: no; 1: yes, always; 2: optionally */
    const char *metavar;             /* what `help` calls the value; NULL: it takes none */
    const char *help;                /* description, without line breaks and without a full stop at its end */
    const char *otherwise;           /* the default in words; NULL: there is none, or `help` states it */
    const char *const *choices;      /* all allowed values, ended by NULL; NULL: other values are allowed too */
    int group;                       /* options of one group belong together; groups are shown in ascending order */
    const char *group_title;
    int repeats;                     /* 1: all values given are used; 0: the last one is */
    int is_borrowed;                 /* 1: means the same as in render */
    const char *refused;             /* why this command refuses the option, which render takes; NULL: it does not */
} eclat_option;

/* Returns command i, from 0, in alphabetical order; NULL beyond the last. */
const eclat_command *eclat_command_at(size_t i);

/* Returns option i, from 0, of a command, in the order of groups; name is NULL beyond the last, or if there is no such command. */
eclat_option eclat_option_at(const char *command, size_t i);

/* ---- Jobs: a command with its inputs and options ---- */

typedef struct eclat_job eclat_job;

/* command: "render", "cost", "info", "compare", "merge", "mix", "devices", "selftest" or "view"; the manual says what each does. */
eclat_result eclat_job_new(const char *command, eclat_job **job, eclat_error *err);
void eclat_job_free(eclat_job *job);

/* Adds an input, the path of a scene or of a picture. Files are read each time the job runs, not before. */
eclat_result eclat_job_add(eclat_job *job, const char *input, eclat_error *err);

/* Sets an option by its name without dashes: "spp" to "256", "size" to "640x480", "device" to "0". value is NULL for an option without a value, and
 * may be for one whose value is optional, such as "adaptive". A later value replaces an earlier one, unless the option repeats. Returns ECLAT_USAGE
 * if there is no such option or the value is wrong. */
eclat_result eclat_job_set(eclat_job *job, const char *option, const char *value, eclat_error *err);

/* Sets the command line, program first, that files and reports of the job state as their origin. If it is not set, they state one composed of inputs
 * and options. */
eclat_result eclat_job_typed(eclat_job *job, int argc, char *const *argv, eclat_error *err);

typedef enum eclat_severity { ECLAT_STATUS, ECLAT_NOTE, ECLAT_WARNING, ECLAT_FAILURE } eclat_severity;

typedef struct eclat_progress {
    double fraction;                   /* 0 to 1: progress towards the limit expected to be met first; never decreases */
    double seconds, seconds_left;      /* seconds_left < 0: unknown */
    double samples_per_pixel;
    double error, error_bound;         /* as in eclat_picture_error; INFINITY for jobs that do not render a single picture */
    const char *text;                  /* all of this and more in words: "37 %  0:12 left  96 spp  5.42 M samples/s  error 2.31 % (bound 2.40 %)" */
} eclat_progress;

/* Callbacks, made from the thread that runs the job or from one of its own, never two at a time. Each may be NULL. Arguments are valid during the
 * call. */
typedef struct eclat_listener {
    void *user;
    /* One line of text. With the option "quiet", only warnings and failures are passed on. */
    void (*message)(void *user, eclat_severity severity, const char *text);
    /* Called about twice a second. Returning 0 stops the job, which keeps what it has so far. */
    int (*progress)(void *user, const eclat_progress *progress);
    /* Delivers the result of the job, or of one of its frames: text, or JSON and a newline with the option "json"; size bytes, and a 0 behind them.
     * Returns NULL, or the reason why it could not be delivered, with which the job fails. */
    const char *(*report)(void *user, const char *text, size_t size);
    int bold;                          /* 1: reports may contain a terminal's escape codes for bold print */
    /* From here to `end`, killing the job loses work. May be called several times. has_progress: `progress` will be called until `end`. */
    void (*begin)(void *user, int has_progress);
    void (*end)(void *user);
    /* Gives the text to show if the process is killed from outside. */
    void (*hint)(void *user, const char *text);
} eclat_listener;

void eclat_job_listen(eclat_job *job, const eclat_listener *listener); /* copies *listener; NULL: none */

/* Asks the job to end soon and to keep what it has so far; if it is not running, this applies to its next run. */
void eclat_job_stop(eclat_job *job);

/* Runs the job and waits for it; a job may be run again. If picture is NULL, results are written to the files of the option "output", or to default
 * names if it is not set. Otherwise "render", "merge" and "mix" return their picture in *picture, and write files only if "output" is set. On failure
 * *picture is NULL, or the picture so far if the failure came after its first samples, as when a device fails. It is also NULL on success if there is
 * no single picture in memory: after a sequence of frames, or if the picture is too large for memory. */
typedef struct eclat_picture eclat_picture;
eclat_result eclat_job_run(eclat_job *job, eclat_picture **picture, eclat_error *err);

/* Returns 1 if the last run succeeded and its answer is no: pictures differ by more than noise, or a case of the self-test failed. */
int eclat_job_says_no(const eclat_job *job);

/* ---- Many machines: the processes started by an MPI launcher, as one renderer ---- */

typedef struct eclat_ranks eclat_ranks;

/* Connects to the other processes; *ranks is NULL if there are none. On failure *ranks may be set, and must then be left. */
eclat_result eclat_ranks_join(eclat_ranks **ranks, eclat_error *err);
int eclat_ranks_number(const eclat_ranks *ranks); /* 0: the first process, which runs the jobs. ranks NULL: 0 or 1, by the launcher's environment */

/* For all processes but the first: helps with its jobs until it leaves, then leaves too, which frees *ranks. A process that fails here does not
 * leave, and should exit, so that the launcher ends the others. */
eclat_result eclat_ranks_serve(eclat_ranks *ranks, const eclat_listener *listener, eclat_error *err);
void eclat_ranks_leave(eclat_ranks *ranks);

/* Lets the other processes help with a job, if it renders. ranks is not copied, and must last until the job has run. */
void eclat_job_share(eclat_job *job, eclat_ranks *ranks);

/* ---- The window of the command "view" ---- */

/* Returns entry i, from 0, of the keys and mouse actions of the window; term is NULL beyond the last, or if the window is not installed. */
eclat_note eclat_view_key_at(size_t i);

/* ---- Pictures ---- */

void eclat_picture_free(eclat_picture *picture);
uint32_t eclat_picture_width(const eclat_picture *picture);
uint32_t eclat_picture_height(const eclat_picture *picture);

/* The distance of the picture from the converged one: see the manual, "The error". */
typedef struct eclat_picture_error {
    double error;          /* relative root-mean-square standard error of luminance; INFINITY: unknown */
    double error_bound;    /* 95 % upper bound; INFINITY: none */
    const char *why;       /* why there is no bound, in words; NULL: there is one */
    double mean_luminance;
    double samples_per_pixel;
    uint32_t replicates;
} eclat_picture_error;
eclat_picture_error eclat_picture_get_error(const eclat_picture *picture);

/* Errors of the denoised picture, and of the best one, a blend of the denoised and the noisy one, with the option "denoise"; in the units of
 * eclat_picture_error. Their planes are the channels "denoised.R", "best.R" and so on. */
typedef struct eclat_stated_error {
    double error, low95, high95;               /* error and its 95 % interval; high95 INFINITY: no bound. All INFINITY: unknown */
} eclat_stated_error;

typedef struct eclat_denoised {
    eclat_stated_error denoised, best;
    double bias, noise;                        /* of the denoised picture: its squared error is bias^2 + noise^2 */
    uint32_t tiles, tiles_nearer, tiles_off;   /* of 16 x 16 pixels: all; the denoised picture is nearer to the truth; it weighs under 5 % in the best one */
    const char *why;                           /* why there is no denoised picture, in words; NULL: there is one */
} eclat_denoised;
eclat_denoised eclat_picture_get_denoised(const eclat_picture *picture);

/* A plane: pixel (x, y), y counted from the top, is data[stride * (y * width + x)]. data belongs to the picture. */
typedef struct eclat_channel {
    const char *name;   /* as in the EXR: "R", "stderr.Y", "depth.Z" */
    const float *data;
    size_t stride;      /* floats */
} eclat_channel;

size_t eclat_picture_channel_count(const eclat_picture *picture);
eclat_channel eclat_picture_channel_at(const eclat_picture *picture, size_t i);            /* data is NULL beyond the last */
eclat_channel eclat_picture_channel(const eclat_picture *picture, const char *name);       /* data is NULL if there is no such channel */

/* A statement of the picture about itself, as in the EXR: "eclat.seed", "eclat.error", ... */
typedef struct eclat_attribute {
    const char *name;
    const char *text; /* NULL: the value is `number` */
    double number;
} eclat_attribute;

size_t eclat_picture_attribute_count(const eclat_picture *picture);
eclat_attribute eclat_picture_attribute_at(const eclat_picture *picture, size_t i);        /* name is NULL beyond the last */
eclat_attribute eclat_picture_attribute(const eclat_picture *picture, const char *name);   /* name is NULL if there is no such attribute */

/* Writes the format of path's ending, as the option "output" does: all channels and attributes to an .exr, the tone-mapped picture to a .png. The
 * file appears under its name only once it is complete. The .exr of a slice can be given to "merge". */
eclat_result eclat_picture_write(const eclat_picture *picture, const char *path, eclat_error *err);

/* ---- Files ---- */

typedef struct eclat_comparison {
    double rmse, relative_rms, relmse, mape, psnr; /* of a against b, as `eclat compare` reports them; psnr in dB */
    double p;                                      /* probability that noise alone makes so large a difference; NAN: neither file has standard errors */
    int differ;                                    /* 1: they differ by more than noise or, without standard errors, by more than rounding */
} eclat_comparison;

/* Compares two .exr files of one size; b is the reference. */
eclat_result eclat_compare(const char *a, const char *b, eclat_comparison *comparison, eclat_error *err);

#ifdef __cplusplus
}
#endif

#include "live.h"

#endif
