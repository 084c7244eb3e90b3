/* The state that the parts of ec_render share: render.c sets up, render_film.c takes batches until a limit is met, render_strips.c does so strip by
 * strip, render_tell.c reports progress. Inside host/render/render*.c only. */
#ifndef EC_RENDER_RENDER_STATE_H
#define EC_RENDER_RENDER_STATE_H

#include "rare/joined.h"
#include "rare/lights.h"
#include "render/course.h"
#include "render/goal.h"
#include "render/sources.h"

typedef struct ec_render_state {
    ec_sources sources;
    ec_batch_source *source;
    ec_params params;          /* width, height and batch are the render's */
    const ec_render_options *options;
    ec_render_options chosen;  /* the caller's options with what they leave open, once that is chosen */
    const ec_course *course;
    ec_progress_fn progress;
    void *user;
    ec_film *film;
    ec_render_stats *stats;
    double start, render_start, cpu_start, last_report;
    double batch_end;          /* when the last one was done */
    ec_goal goal;
    uint32_t replicates;
    uint32_t end;              /* whole batches end before this one; UINT32_MAX where no number of samples ends them */
    uint32_t cut;              /* samples that batch `end` lacks, if it is wanted: else 0 */
    ec_film_error error;
    ec_error_sums sums;        /* of the film when it was last looked at */
    bool is_looked_at;         /* error is the film's as it is now */
    double look_seconds;       /* time that this took; 0: not known */
    double look_cpu_seconds;   /* for looks at the picture's paths, which no limit of time counts */
    bool is_withheld_noted;
    bool was_narrow;           /* the last batch ended with the kernels that the render began with (device/tiers.h) */
    ec_rare_lights lights;     /* until their rare light is predicted; owned */
    ec_rare rare;              /* the rare light that is predicted */
    ec_joined_choice joined;   /* how many light paths pay */
    bool is_predicted;
    ec_past past;              /* samples: in the film */
    uint64_t rays_before, invalid_before[EC_STAGE_COUNT]; /* the course's past */
    ec_batch_order order;      /* the batch under way */
    bool look_failed;          /* a look at what the batch has come to so far has failed */
    ec_error look_error;
    double samples_before_it;  /* a pixel */
    uint64_t under_way;        /* samples of the batch that is not there yet */
    uint32_t room_made;        /* pixels of the first batch for which the film has memory */
    double kept_at;
    uint32_t kept_next, kept_under_way;
    float *layers, *layer;     /* layers of a batch, until they are in the film; one of them as a batch */
    ec_matte_log matte;        /* what the samples of a batch meet, until it is in the film */
    pthread_mutex_t matte_lock;
    float limit;               /* ec_params.limit; 0: none, or not known yet */
    uint64_t cleaned_samples;  /* samples in the film when its clean picture was last looked at; 0: it was not */
    const char *stopped_by;
    uint32_t strip_rows;       /* of a strip; 0: the picture is rendered whole */
    uint64_t samples_before, invalid_in_films; /* of the strips that are complete */
} ec_render_state;

/* Pixels of the film: the picture, or the strip under way. */
static inline double ec_render_film_pixels(const ec_render_state *r) { return (double)r->film->width * r->film->height; }
static inline double ec_render_picture_pixels(const ec_render_state *r) { return (double)r->options->width * r->options->height; }

/* Returns the samples a pixel, in the mean; ec_render_mark: these and the seconds. */
static inline double ec_render_samples_done(const ec_render_state *r) { return (double)r->past.samples / ec_render_film_pixels(r); }
ec_mark ec_render_mark(const ec_render_state *r);

/* render_predict.c: takes the first look at the picture's paths, once; its time is not the render's. Several devices have it before the first wave;
 * one device after that, which need not wait for it. */
ec_result ec_render_predict(ec_render_state *r, ec_error *err);

/* render_add.c: adds the batch of the order, complete or given up, to the film. */
ec_result ec_render_add_batch(ec_render_state *r, bool complete, ec_error *err);
/* Adds a whole batch of what light paths bring to the film's light. */
ec_result ec_render_add_light(ec_render_state *r, ec_error *err);
/* Hands to `keep` what there is; also of a batch under way, but not of its layers, nor of a pass that is larger than the picture. What is kept ends
 * before a batch that is cut short, from which no render can go on. */
void ec_render_keep(ec_render_state *r, uint32_t under_way);
uint32_t ec_render_wants_sets(const ec_render_state *r); /* sets of features that come with the next batch */
uint64_t ec_render_order_samples(const ec_render_state *r); /* of each position of the order */

/* render_film.c: renders until a limit is met; what is there before stays in the film. */
ec_result ec_render_film(ec_render_state *r, const ec_log *log, ec_error *err);

/* caustics.c: decides whether light paths pay, if the options leave it open and the scene may call for them. On the only source, before the first
 * sample. */
typedef enum ec_caustics {
    EC_CAUSTICS_NONE,   /* none for which light paths would pay */
    EC_CAUSTICS_COMMON, /* paths meet them often enough to make noise: light paths pay */
    EC_CAUSTICS_RARE    /* paths hardly ever meet them: guides pay, too */
} ec_caustics;
bool ec_render_may_have_caustics(const ec_render_options *options, const ec_scene *scene);
ec_result ec_render_judge_caustics(ec_render_state *r, ec_caustics *caustics, const ec_log *log, ec_error *err);

/* limit.c: finds the picture's mean luminance, by so many samples of its own, a multiple of 32; the source has been turned to these rows.
 * ec_render_find_limit: sets the limit, once, before the first sample of a render that has a clamp. */
ec_result ec_render_pilot_mean(ec_render_state *r, uint32_t samples, uint32_t rows, double *mean, ec_error *err);
ec_result ec_render_find_limit(ec_render_state *r, uint32_t rows, const ec_log *log, ec_error *err);

/* render_strips.c: sets r->strip_rows if there is memory for some rows only. Small pictures do not look. */
ec_result ec_render_choose_rows(ec_render_state *r, const ec_log *log, ec_error *err);
ec_result ec_render_strips(ec_render_state *r, const ec_log *log, ec_error *err);

/* render_tell.c: reports progress to the caller; returns false if it is to stop. samples: a pixel, with those under way. */
bool ec_render_tell(ec_render_state *r, double samples);
/* Fills in the stats without the device, which may be lost. */
void ec_render_finish_stats(ec_render_state *r);

#endif
