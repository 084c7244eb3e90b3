/* A course: which batches of a job a render takes, what was done before it, and what it keeps on the way. */
#ifndef EC_RENDER_COURSE_H
#define EC_RENDER_COURSE_H

#include "film/forecast.h"
#include "device/adaptive.h"
#include "render/clean_goal.h"
#include "render/render.h"
#include "render/sources.h"

/* The state of a render between two waves, beside its film: from both, another render goes on as if there had been no break. */
typedef struct ec_past {
    uint32_t next;                    /* the index of the next batch, or pass of an adaptive render */
    uint64_t samples, rays;           /* done */
    double seconds;                   /* of rendering */
    uint64_t invalid[EC_STAGE_COUNT]; /* dropped by the kernels, by ec_stage */
    uint32_t under_way;               /* pixels of batch `next`, in the order of its pass, that are done … */
    const float *batch;               /* … and what they came to, EC_BATCH_FIELDS a pixel of the image; NULL: none are done */
    const float *features;            /* likewise, EC_FILM_FEATURES a pixel; NULL: the batch has none */
    ec_slope slope;                   /* slope that the rounds so far show; an allotment changes it */
    bool allotted;                    /* the pilot of an adaptive render is over, and its allotment is made */
    ec_allotment allotment;           /* weight, gain and level are used; without weights sampling stays uniform */
} ec_past;

typedef struct ec_course {
    uint32_t first, end;              /* batches [first, end) of the job; end 0: whatever the limits say … */
    uint32_t cut;                     /* samples that the last of them lacks */
    uint32_t most;                    /* … but not beyond so many samples a pixel; 0: any number */
    const ec_past *past;              /* of the film that ec_render_course is given; NULL: a new one. The caller owns its memory */
    /* Called once the scene is on the device and stats->content is known, before the first sample. Its failure ends the render. May be NULL. */
    ec_result (*admit)(void *user, const ec_render_stats *stats, ec_error *err);
    /* Called once all of the scene is on the device that renders alone: the scene's data (ec_scene_drop_data) are not read any more. May be NULL. */
    void (*loaded)(void *user);
    /* Called between two waves, every so many seconds, and at the end, once the film has a batch. Returns false if it could not keep it: the render
     * goes on, and tries again. NULL: never. */
    bool (*keep)(void *user, const ec_film *film, const ec_past *past);
    bool past_is_kept;                /* `keep` has the past already: it is not called before there is more */
    double every;
    /* Takes a complete strip, from the top, of a picture that does not fit into memory and is rendered in strips (strips.h): called with its
     * first row and what is known so far; samples include those of strips before it. Its failure ends the render. The film is then made anew; in
     * the end it is empty, unless there was one strip only, which is not told. NULL: pictures are rendered whole, because of what `whole_for`
     * says, an option as on the command line. */
    ec_result (*strip)(void *user, const ec_film *film, uint32_t first_row, const ec_render_stats *stats, ec_error *err);
    const char *whole_for;
    /* Called with options.denoise at some of the rounds: sets *look to the error of the film's clean picture. It may change film->clean. NULL: not
     * asked for. */
    ec_result (*clean)(void *user, ec_film *film, ec_clean_look *look, ec_error *err);
    const ec_peers *peers;          /* other sources that take batches too; NULL: none */
    void *user;
} ec_course;

/* Renders like ec_render, by a course, on all of these devices at once (1 to EC_DEVICES_MOST). A device that fails is left out with a warning; the
 * render fails only when there is none left. Host memory beside the film: a batch and its first-hit features, 56 bytes a pixel, with one device, else
 * also ec_team_bytes (team.h). film must be zero-initialised, or with a past hold what was done, at options' size. */
ec_result ec_render_course(ec_cl *devices, uint32_t device_count, const ec_scene *scene,
                           const ec_render_options *options, const ec_course *course, ec_progress_fn progress,
                           void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err);

#endif
