/* Everything that a finished render reports, as text, as JSON and as EXR attributes. */
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
    const char *name;               /* NULL: a frame, by its number */
    uint32_t number, place, count;  /* the place-th of so many, from 1 */
    double seconds;                 /* of the animation */
    bool turns;                     /* it is one of a turntable, */
    double degrees;                 /* the camera having gone round so far */
    const char *job;                /* what it is of, for a later run: an attribute of its files */
} ec_frame_facts;

typedef struct ec_render_report {
    const ec_frame_facts *frame;    /* NULL: it is none */
    const char *command;            /* the command line, quoted for a shell */
    const char *scene;              /* file */
    const char *camera;             /* in words */
    ec_viewpoint viewpoint;         /* the same in figures */
    const char *environment;        /* --env, or in words */
    const ec_render_options *options;
    const ec_render_stats *stats;
    bool verbose;                   /* every effect with what calls for it */
    const ec_device_info *device;   /* as many as there are shares in stats, or one */
    const uint32_t *device_index;
    const char *device_why;         /* "first GPU" */
    double exposure;                /* EV, of the PNG */
    bool is_exposure_auto;
    ec_background background;
    const ec_behind *behind;        /* NULL: no blurred environment is */
    bool has_shadow;                /* alpha has that on a ground, */
    double shadow_error;            /* with this standard error; NaN: not known */
    const ec_matte_names *mattes;   /* of the channels cryptomatte */
    bool is_png_deep;               /* 16 bits */
    ec_tonemap tonemap;
    const ec_ocio_choice *view;     /* in its place, and … */
    const ec_ocio *ocio;            /* … what it makes; NULL: none */
    double mean_luminance;
    uint32_t replicates;            /* that have samples; with fewer than two no error is known */
    ec_clamp_error clamp;           /* where options have one */
    const ec_denoised *denoised;    /* NULL: nobody has asked for it */
    uint64_t heavy_pixels;          /* see film/interval.h */
    double load_seconds;            /* scene and environment */
    double write_seconds, total_seconds; /* known only after the files are written */
    uint64_t peak_memory_bytes;
    const char *image_sha256;       /* of the float R, G, B values, row by row from the top */
    const char **outputs;           /* absolute paths */
    int output_count;
} ec_render_report;


/* NULL: its options have none. */
static inline const ec_clamp_error *ec_render_report_clamp(const ec_render_report *report)
{
    return report->options->clamp > 0 ? &report->clamp : NULL;
}

void ec_render_report_text(const ec_render_report *report, FILE *to);
/* "0.5 s" or "90 degrees". */
void ec_frame_when(const ec_frame_facts *frame, char *text, size_t size);
/* One line for a frame. */
void ec_frame_report_text(const ec_render_report *report, FILE *to);
ec_result ec_render_report_json(const ec_render_report *report, FILE *to, ec_error *err);

/* "error 1.93 % (95 % bound 1.97 %) at 256 samples a pixel in 12.3 s, 5.42 M samples/s" */
void ec_render_report_summary(const ec_render_report *report, char *text, size_t size);

/* EXR attributes: all that is needed to render the picture again, and what came of it. */
void ec_render_report_attributes(const ec_render_report *report, ec_report_attributes *attributes);

#endif
