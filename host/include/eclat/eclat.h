/* libeclat: renders glTF 2.0 scenes to physically based images with a stated error, on any OpenCL device.
 *
 *     eclat_job *job = NULL;
 *     eclat_picture *picture = NULL;
 *     eclat_error err;
 *     if (eclat_job_new("scene.glb", &job, &err) || eclat_job_set(job, "error", "2%", &err) ||
 *         eclat_job_render(job, &picture, &err) || eclat_picture_write(picture, "scene.exr", &err))
 *         fprintf(stderr, "%s\n", err.text);
 *     eclat_picture_free(picture);
 *     eclat_job_free(job);
 *
 * Errors. Functions that can fail return an eclat_result and fill an eclat_error (which may be NULL) with one line: what went wrong, where, and
 * how to mend it. What they were to create is NULL then.
 * Ownership. The caller frees what _new, _list, _render and _merge create by the _free of its type, which takes NULL too. Texts and arrays that
 * are returned as const belong to the object they are asked of, and last as long as it.
 * Threads. Objects are independent of one another: each may be used by any one thread at a time. eclat_job_stop alone may be called at any
 * time from any thread, or from a signal handler. A render uses all cores or the device that it is told. The library has no global state,
 * prints nothing, and installs no signal handler; an OpenCL driver may.
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

/* ---- Jobs: a scene, and how it is to be rendered ---- */

typedef struct eclat_job eclat_job;

/* scene: the path of a .gltf or .glb. It is read when the job renders, each time. */
eclat_result eclat_job_new(const char *scene, eclat_job **job, eclat_error *err);
void eclat_job_free(eclat_job *job);

/* Options by the names that `eclat render --help` lists, without dashes: "spp" "256", "size" "640x480", "device" "0". value: NULL for one that takes
 * none, as "adaptive" may. The last one counts, but "output" and "without" add to what was set. Fails with ECLAT_USAGE where there is no such option or
 * the value is wrong. Without "output" a render writes no files. */
eclat_result eclat_job_set(eclat_job *job, const char *option, const char *value, eclat_error *err);

typedef struct eclat_option {
    const char *name;
    int takes_value; /* 0, 1, or 2: it may */
} eclat_option;

/* The options that eclat_job_set takes, i from 0 on; name NULL behind the last. */
eclat_option eclat_option_at(size_t i);

typedef enum eclat_severity { ECLAT_STATUS, ECLAT_NOTE, ECLAT_WARNING, ECLAT_FAILURE } eclat_severity;

typedef struct eclat_progress {
    double fraction;                   /* 0 to 1, of the first limit that will end the render */
    double seconds, seconds_left;      /* seconds_left < 0: not known */
    double samples_per_pixel;
    double error, error_bound;         /* as eclat_picture_error has them */
} eclat_progress;

/* Called from the thread that renders, never two at a time. */
typedef struct eclat_listener {
    void *user;
    void (*message)(void *user, eclat_severity severity, const char *text); /* one line. NULL: messages are dropped */
    int (*progress)(void *user, const eclat_progress *progress);            /* about twice a second; 0 stops the render and keeps the picture so far */
} eclat_listener;

void eclat_job_listen(eclat_job *job, const eclat_listener *listener); /* copied; NULL: nobody */

/* Asks the render that is under way, or the next one, to end soon and to keep the picture so far. */
void eclat_job_stop(eclat_job *job);

/* Renders and waits. *picture is NULL on failure, but where the device failed halfway: then it is the picture so far. It is NULL on success too
 * for what goes to the files of "output" alone: a sequence (option "frames"), and a picture that does not fit into memory. A job may render again. */
typedef struct eclat_picture eclat_picture;
eclat_result eclat_job_render(eclat_job *job, eclat_picture **picture, eclat_error *err);

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
 * eclat_merge takes. */
eclat_result eclat_picture_write(const eclat_picture *picture, const char *path, eclat_error *err);

/* ---- Files ---- */

typedef struct eclat_comparison {
    double rmse, relative_rms, relmse, mape, psnr; /* of a against b, as `eclat compare` has them; psnr in dB */
    double p;                                      /* that noise alone makes so large a difference; NAN: neither file has standard errors */
    int differ;                                    /* by more than noise, or, without standard errors, by more than rounding */
} eclat_comparison;

/* Two .exr files of one size; b is the reference. */
eclat_result eclat_compare(const char *a, const char *b, eclat_comparison *comparison, eclat_error *err);

/* Makes one picture of slices (option "samples") or checkpoints of one job. listener may be NULL. is_partial: samples may be missing. */
eclat_result eclat_merge(const char *const *paths, size_t count, int is_partial, const eclat_listener *listener, eclat_picture **picture, eclat_error *err);

#ifdef __cplusplus
}
#endif
#endif
