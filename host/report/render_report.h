/* Everything that a finished render reports: as text, JSON and EXR attributes. */
#ifndef EC_REPORT_RENDER_REPORT_H
#define EC_REPORT_RENDER_REPORT_H

#include <stdint.h>
#include <stdio.h>

#include "cl/cl.h"
#include "denoise/denoise.h"
#include "film/clamp.h"
#include "render/render.h"
#include "report/attributes.h"
#include "scene/matte_names.h"

/* A frame of a sequence, or one of several pictures. */
typedef struct ec_frame_facts {
    const char *name;               /* NULL: a frame, known by its number */
    uint32_t number, place, count;  /* place: among `count`, from 1 */
    double seconds;                 /* time in the animation */
    bool turns;                     /* the camera goes round */
    double degrees;                 /* how far the camera has gone round */
    const char *job;                /* identity for later runs: an attribute of its files */
} ec_frame_facts;

typedef struct ec_render_report {
    const ec_frame_facts *frame;    /* NULL: a single picture */
    const char *command;            /* the command line, quoted for a shell */
    const char *scene;              /* path */
    const char *camera;             /* in words */
    ec_viewpoint viewpoint;         /* the same in numbers */
    const char *environment;        /* value of --env, or a description */
    const ec_render_options *options;
    const ec_render_stats *stats;
    bool verbose;                   /* lists every effect with what calls for it */
    const ec_device_info *device;   /* one for each share in stats, or a single one */
    const uint32_t *device_index;
    const char *device_why;         /* e.g. "first GPU" */
    double exposure;                /* stops, of the PNG */
    bool is_exposure_auto;
    ec_background background;
    const ec_behind *behind;        /* NULL: no blurred environment */
    bool has_shadow;                /* alpha includes the shadow on a ground, */
    double shadow_error;            /* with this standard error; NaN: unknown */
    const ec_matte_names *mattes;   /* for the channels of Cryptomatte */
    bool is_png_deep;               /* the PNG has 16 bits */
    ec_tonemap tonemap;
    const ec_ocio_choice *view;     /* replaces tonemap, and … */
    const ec_ocio *ocio;            /* … its processor; NULL: none */
    double mean_luminance;
    uint32_t replicates;            /* those with samples; with fewer than two the error is unknown */
    ec_clamp_error clamp;           /* valid if options have a clamp */
    const ec_denoised *denoised;    /* NULL: not asked for */
    uint64_t heavy_pixels;          /* see film/interval.h */
    double load_seconds;            /* for scene and environment */
    double write_seconds, total_seconds; /* known only once the files are written */
    uint64_t peak_memory_bytes;
    const char *image_sha256;       /* of R, G, B as floats, row by row from the top */
    const char **outputs;           /* absolute paths */
    int output_count;
} ec_render_report;


/* Returns NULL if the options have no clamp. */
static inline const ec_clamp_error *ec_render_report_clamp(const ec_render_report *report)
{
    return report->options->clamp > 0 ? &report->clamp : NULL;
}

void ec_render_report_text(const ec_render_report *report, FILE *to);
/* Writes "0.5 s" or "90 degrees". */
void ec_frame_when(const ec_frame_facts *frame, char *text, size_t size);
/* Prints one line for a frame. */
void ec_frame_report_text(const ec_render_report *report, FILE *to);
ec_result ec_render_report_json(const ec_render_report *report, FILE *to, ec_error *err);

/* Writes e.g. "error 1.93 % (95 % bound 1.97 %) at 256 samples a pixel in 12.3 s, 5.42 M samples/s". */
void ec_render_report_summary(const ec_render_report *report, char *text, size_t size);

/* Adds EXR attributes: everything needed to render the picture again, and the results. */
void ec_render_report_attributes(const ec_render_report *report, ec_report_attributes *attributes);

#endif
