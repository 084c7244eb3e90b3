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
 * Errors. Functions that can fail return an eclat_result and fill an eclat_error (which may be NULL) with one line: what went wrong, where, and
 * how to mend it. What they were to create is NULL then.
 * Ownership. The caller frees what _new, _list, _join and _run create by the _free or _leave of its type, which takes NULL too. Texts and arrays
 * that are returned as const belong to the object they are asked of, and last as long as it; those of tables last for ever.
 * Threads. Objects are independent of one another: each may be used by any one thread at a time. eclat_job_stop alone may be called at any
 * time from any thread, or from a signal handler. A job uses all cores or the device that it is told. The library has no global state,
 * prints nothing, and installs no signal handler; an OpenCL driver may. A render whose kernels the driver does not have yet starts the program
 * eclat-compile, which outlives it by some seconds; the option compile "first" does without.
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

/* EC_VERSION of the library that is running; its first number is that of the SONAME. */
const char *eclat_version(void);

/* A term and what it means. */
typedef struct eclat_note {
    const char *heading; /* the title of a group of options, or one of its own */
    const char *term, *text;
} eclat_note;

/* How the library was built, and what it has: compiler, OpenCL version, readers of compressed scenes, modules that are installed. Term NULL behind the
 * last. */
eclat_note eclat_build_at(size_t i);

typedef enum eclat_result {
    ECLAT_OK = 0,
    ECLAT_FAILED = 1, /* a file, a device, memory, or stopped before there was a picture */
    ECLAT_USAGE = 2   /* an option or an argument is wrong */
} eclat_result;

typedef enum eclat_error_kind { ECLAT_ERROR_OTHER, ECLAT_ERROR_HOST_MEMORY, ECLAT_ERROR_DEVICE_MEMORY, ECLAT_ERROR_DEVICE } eclat_error_kind;

typedef struct eclat_error {
    char text[2048]; /* one line, no newline at its end */
    eclat_error_kind kind;
} eclat_error;

/* ---- Devices ---- */

typedef struct eclat_device {
    const char *name, *vendor, *driver, *platform;
    uint64_t memory_bytes;
    uint32_t compute_units;
    int is_usable; /* available, and with a compiler */
} eclat_device;

/* Every OpenCL device in the order that the option `device` counts; *count of them. Free by eclat_devices_free. */
eclat_result eclat_devices_list(eclat_device **devices, size_t *count, eclat_error *err);
void eclat_devices_free(eclat_device *devices);

/* ---- Commands: what jobs there are, and which options they take ---- */

typedef struct eclat_command {
    const char *name;                /* "render" */
    const char *operands;            /* what follows the name: "SCENE [options]" */
    const char *summary;             /* a line on what it does */
    const char *intro, *closing;     /* paragraphs before and after its options; closing NULL: none */
    const char *borrows;             /* heading for its borrowed options, which are then listed by name alone; NULL: they are told like its own */
    const char *lacks;               /* heading for the options that it refuses; NULL: it refuses none */
    const eclat_note *notes;         /* a NULL heading ends them; NULL: there are none */
} eclat_command;

typedef struct eclat_option {
    const char *name;                /* "spp" */
    char letter;                     /* its short form on a command line; 0: none */
    int takes_value;                 /* 0, 1, or 2: it may */
    const char *metavar;             /* what `help` calls the value; NULL: it takes none */
    const char *help;                /* without a line break or a full stop at its end */
    const char *otherwise;           /* the default in words; NULL: there is none, or `help` says it */
    const char *const *choices;      /* all values that it takes, NULL behind the last; NULL: others too */
    int group;                       /* options that belong together; shown in the order of these numbers */
    const char *group_title;
    int repeats;                     /* every value counts, not the last one alone */
    int is_borrowed;                 /* it is what it is in `render` */
    const char *refused;             /* why this command does not take it, though `render` does; NULL: it does */
} eclat_option;

/* By name, i from 0 on; NULL behind the last. */
const eclat_command *eclat_command_at(size_t i);

/* The options of a command, by group; name NULL behind the last, and where there is no such command. */
eclat_option eclat_option_at(const char *command, size_t i);

/* ---- Jobs: a command, its inputs, its options ---- */

typedef struct eclat_job eclat_job;

/* command: "render", "cost", "info", "compare", "merge", "mix", "devices", "selftest" or "view"; the manual says what each does. */
eclat_result eclat_job_new(const char *command, eclat_job **job, eclat_error *err);
void eclat_job_free(eclat_job *job);

/* Adds an input: the path of a scene, or of a picture. Files are read when the job runs, each time. */
eclat_result eclat_job_add(eclat_job *job, const char *input, eclat_error *err);

/* Sets an option by its name, without dashes: "spp" "256", "size" "640x480", "device" "0". value: NULL for one that takes none, as "adaptive" may.
 * The last one counts, but options that repeat add to what was set. Fails with ECLAT_USAGE where there is no such option or the value is wrong. */
eclat_result eclat_job_set(eclat_job *job, const char *option, const char *value, eclat_error *err);

/* The command line that the job stands for, its program first: what its files and reports say of where they come from. Without it, that is a
 * line made of inputs and options. */
eclat_result eclat_job_typed(eclat_job *job, int argc, char *const *argv, eclat_error *err);

typedef enum eclat_severity { ECLAT_STATUS, ECLAT_NOTE, ECLAT_WARNING, ECLAT_FAILURE } eclat_severity;

typedef struct eclat_progress {
    double fraction;                   /* 0 to 1, of the first limit that will end the job; it never falls */
    double seconds, seconds_left;      /* seconds_left < 0: not known */
    double samples_per_pixel;
    double error, error_bound;         /* as eclat_picture_error has them; of jobs that do not render one picture, INFINITY */
    const char *text;                  /* the same, and more, in words: "37 %  0:12 left  96 spp  5.42 M samples/s  error 2.31 % (bound 2.40 %)" */
} eclat_progress;

/* Called from the thread that runs the job, or from one of its own; never two at a time. Functions may be NULL. */
typedef struct eclat_listener {
    void *user;
    /* One line. With the option `quiet` there are warnings and failures only. */
    void (*message)(void *user, eclat_severity severity, const char *text);
    /* About twice a second; 0 stops the job and keeps what there is so far. */
    int (*progress)(void *user, const eclat_progress *progress);
    /* What came of the job, or of one frame of it: in words, or as JSON and a newline with the option `json`. Returns NULL, or why it has not
     * arrived, with which the job fails. */
    const char *(*report)(void *user, const char *text, size_t size);
    int bold;                          /* a report may have the escape codes of a terminal for bold print */
    /* From here on a job that is killed loses something; may come several times. has_progress: progress follows, up to `end`. */
    void (*begin)(void *user, int has_progress);
    void (*end)(void *user);
    /* What to tell should the process be killed from outside. Valid during the call. */
    void (*hint)(void *user, const char *text);
} eclat_listener;

void eclat_job_listen(eclat_job *job, const eclat_listener *listener); /* copied; NULL: nobody */

/* Asks the job, or its next run, to end soon and to keep what there is so far. */
void eclat_job_stop(eclat_job *job);

/* Runs and waits; a job may run again. picture NULL: what the job makes goes to the files of the option "output", or to those that it names by
 * itself. Otherwise jobs that make one picture, "render", "merge" and "mix", give it, and write files only where "output" names them. *picture is NULL
 * on failure, but where the device failed halfway: then it is the picture so far. It is NULL on success too where there is none: of a sequence
 * of frames, or of a picture that does not fit into memory. */
typedef struct eclat_picture eclat_picture;
eclat_result eclat_job_run(eclat_job *job, eclat_picture **picture, eclat_error *err);

/* 1 where the answer of the last run that succeeded is no: pictures differ by more than noise, or a case of the self-test failed. */
int eclat_job_says_no(const eclat_job *job);

/* ---- Many machines: the processes that an MPI launcher has started, as one renderer ---- */

typedef struct eclat_ranks eclat_ranks;

/* Finds the others; *ranks is NULL where this process is alone. It may be there on failure too, and is to be left then. */
eclat_result eclat_ranks_join(eclat_ranks **ranks, eclat_error *err);
int eclat_ranks_number(const eclat_ranks *ranks); /* 0: the first, whose jobs the others help with. NULL: by the launcher's word */

/* What all others do: helps until the first one leaves, and leaves. */
eclat_result eclat_ranks_serve(eclat_ranks *ranks, const eclat_listener *listener, eclat_error *err);
void eclat_ranks_leave(eclat_ranks *ranks);

/* Lets them help with a job, if it renders. */
void eclat_job_share(eclat_job *job, eclat_ranks *ranks);

/* ---- The window of the command "view" ---- */

/* What keys and the mouse do there; term NULL behind the last, and where there is no window to be had. */
eclat_note eclat_view_key_at(size_t i);

/* ---- Pictures ---- */

void eclat_picture_free(eclat_picture *picture);
uint32_t eclat_picture_width(const eclat_picture *picture);
uint32_t eclat_picture_height(const eclat_picture *picture);

/* How far the picture is from the converged one: see the manual, "The error". */
typedef struct eclat_picture_error {
    double error;          /* relative root-mean-square standard error of luminance; INFINITY where it is not known */
    double error_bound;    /* 95 % upper bound; INFINITY where there is none */
    const char *why;       /* why there is no bound, in words; NULL: there is one */
    double mean_luminance;
    double samples_per_pixel;
    uint32_t replicates;
} eclat_picture_error;
eclat_picture_error eclat_picture_get_error(const eclat_picture *picture);

/* With the option "denoise": how far the denoised picture is from the converged one, and the best one, a blend of both; in eclat_picture_error's units.
 * Their planes are the channels "denoised.R" and "best.R" and so on. */
typedef struct eclat_stated_error {
    double error, low95, high95;               /* and its 95 % interval; high95 INFINITY: there is no bound. All INFINITY: not known */
} eclat_stated_error;

typedef struct eclat_denoised {
    eclat_stated_error denoised, best;
    double bias, noise;                        /* of the denoised one: its squared error is the sum of their squares */
    uint32_t tiles, tiles_nearer, tiles_off;   /* of 16 x 16 pixels: where the denoised one is nearer to the truth; where the best one has under 5 % of it */
    const char *why;                           /* why there is none, in words; NULL: there is one */
} eclat_denoised;
eclat_denoised eclat_picture_get_denoised(const eclat_picture *picture);

/* A plane: pixel (x, y), y counted from the top, is data[stride * (y * width + x)]. */
typedef struct eclat_channel {
    const char *name;   /* "R", "stderr.Y", "depth.Z": those of the EXR */
    const float *data;
    size_t stride;      /* floats */
} eclat_channel;

size_t eclat_picture_channel_count(const eclat_picture *picture);
eclat_channel eclat_picture_channel_at(const eclat_picture *picture, size_t i);            /* data NULL behind the last */
eclat_channel eclat_picture_channel(const eclat_picture *picture, const char *name);       /* data NULL where there is no such channel */

/* What the picture tells of itself, as in the EXR: "eclat.seed", "eclat.error", ... */
typedef struct eclat_attribute {
    const char *name;
    const char *text; /* NULL: it is a number */
    double number;
} eclat_attribute;

size_t eclat_picture_attribute_count(const eclat_picture *picture);
eclat_attribute eclat_picture_attribute_at(const eclat_picture *picture, size_t i);        /* name NULL behind the last */
eclat_attribute eclat_picture_attribute(const eclat_picture *picture, const char *name);   /* name NULL where there is no such attribute */

/* All channels and attributes to an .exr, or the tone-mapped picture to a .png. The file has its name only once it is whole. A slice's .exr is one that
 * "merge" takes. */
eclat_result eclat_picture_write(const eclat_picture *picture, const char *path, eclat_error *err);

/* ---- Files ---- */

typedef struct eclat_comparison {
    double rmse, relative_rms, relmse, mape, psnr; /* of a against b, as `eclat compare` has them; psnr in dB */
    double p;                                      /* that noise alone makes so large a difference; NAN: neither file has standard errors */
    int differ;                                    /* by more than noise, or, without standard errors, by more than rounding */
} eclat_comparison;

/* Two .exr files of one size; b is the reference. */
eclat_result eclat_compare(const char *a, const char *b, eclat_comparison *comparison, eclat_error *err);

#ifdef __cplusplus
}
#endif

#include "live.h"

#endif
