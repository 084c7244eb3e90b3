/* Writes a film to files. */
#ifndef EC_JOBS_WRITE_OUTPUTS_H
#define EC_JOBS_WRITE_OUTPUTS_H

#include "film/channels.h"
#include "film/layer_films.h"
#include "jobs/channel_list.h"
#include "jobs/outputs.h"
#include "film/resolve.h"
#include "image/image.h"
#include "store/store.h"

/* Float planes of a film or of some of its rows, ready to be written and hashed. 64 bytes per pixel, 20 if no error is known; 32 more if features
 * have to be collected. */
typedef struct ec_picture {
    uint32_t width, height;
    uint32_t first;    /* row of the whole picture at which it begins */
    float *rgb;        /* 3 per pixel, owned */
    /* The error of each pixel; all NULL with fewer than two replicates. Owned. */
    float *stderr_rgb; /* 3 per pixel */
    float *stderr_y;   /* 1 per pixel: of luminance */
    float *low, *high; /* 3 per pixel: 95 % interval, if wanted */
    float *heavy;      /* 1 per pixel: see film/interval.h */
    uint64_t heavy_count;
    float *clamped;    /* 2 per pixel: luminance that a clamp removed, and its standard error; NULL: not clamped. Owned */
    float *constants;  /* 2 per pixel: samples, and the alpha of a film without first-hit features. Owned */
    ec_layers layers;  /* additional layers */
    float *layer_values; /* EC_LAYER_PLANES of each, per pixel; NULL: none. Owned */
    float *mattes[EC_MATTE_KINDS]; /* EC_MATTE_FLOATS of each that is asked for, per pixel; NULL for others. Owned */
    ec_pixel *room;    /* for ec_film_resolve_rows; owned */
    float *features;   /* EC_FILM_FEATURES per pixel, if the film does not have them in one place; owned */
    const float *aov;  /* these features, or the film's; NULL: none */
    ec_film_clean clean; /* the film's denoised picture, or NULLs */
} ec_picture;

/* Resolves the whole film. with_error false: what is known of the error stays NULL. */
ec_result ec_picture_resolve(const ec_film *film, bool with_error, ec_picture *picture, ec_error *err);

/* A picture in pieces: create allocates `rows` rows for such a film, fill resolves rows [first, first + rows) of the film there. */
ec_result ec_picture_create(ec_picture *picture, const ec_film *film, uint32_t rows, bool with_error, bool with_intervals, bool with_cut, ec_error *err);
void ec_picture_turn_to(ec_picture *picture, const ec_film *film, uint32_t first); /* points to those data that stay in the film, from row `first` on */
void ec_picture_fill(ec_picture *picture, const ec_film *film, uint32_t first, uint32_t rows);

/* Returns a part of it, which owns nothing and can be filled by itself. */
ec_picture ec_picture_rows(const ec_picture *picture, uint32_t first, uint32_t rows);

enum { EC_MATTE_NAME = 20 };

/* The channels of a picture; those of the error and of first hits only if they are known. */
enum { EC_CHANNELS_MOST = EC_CHANNEL_ROWS + EC_MATTE_KINDS * EC_MATTE_FLOATS + EC_GROUPS_MOST * EC_GROUP_ROWS };
/* Must not be copied, as names may point into it. */
typedef struct ec_channel_list {
    ec_channel list[EC_CHANNELS_MOST];
    const ec_channel_row *rows[EC_CHANNELS_MOST];
    char names[EC_GROUPS_MOST][EC_GROUP_ROWS][EC_GROUP_NAME + 16]; /* of light groups */
    char matte_names[EC_MATTE_KINDS][EC_MATTE_FLOATS][EC_MATTE_NAME];
    uint32_t count;
} ec_channel_list;
void ec_picture_channels(const ec_picture *picture, ec_channel_list *channels); /* lists all, as 32-bit floats */

/* Keeps the channels that are in the set, with the types of a picture's file; wide_errors: standard errors are 32-bit floats. */
void ec_channels_choose(ec_channel_list *channels, ec_channel_set set, bool wide_errors);

void ec_picture_free(ec_picture *picture); /* zero-initialised ones are fine */

typedef struct ec_picture_style {
    ec_screen screen; /* for all formats but EXR */
    bool deep;        /* 16 bits, if the format has them */
    ec_channel_set channels; /* of an EXR, for ec_row_writer */
    const ec_attribute *attributes; /* EXR only */
    uint32_t attribute_count;
    ec_png_text text; /* PNG: stored in it by ec_row_writer */
    bool is_sealed;   /* EXR, for ec_row_writer: adds a seal, so that damage is detected */
    /* EXR only: sums to resume from or to merge; all NULL: a picture alone */
    const ec_job *job;
    const ec_film *film;
    const ec_past *past;
} ec_picture_style;

/* Writes one EXR, as ec_outputs_write does. */
ec_result ec_picture_write_exr(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err);

/* The pixel format of a file other than EXR; and rows of a picture converted to it. */
ec_raster ec_picture_raster(const ec_format *format, const ec_picture_style *style, uint32_t width, uint32_t height);
void ec_picture_pixels(const ec_picture *picture, const ec_picture_style *style, const ec_raster *to, void *out);

/* Makes the path absolute, once the file is written. */
void ec_output_settle(ec_output *output);

/* Writes every output and makes its path absolute. One that fails does not keep the others from being written. */
ec_result ec_outputs_write(ec_outputs *outputs, const ec_picture *picture, const ec_picture_style *style, ec_error *err);

#endif
