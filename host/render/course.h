/* Which batches of a job a render takes, what was done before it, and what it keeps on the way. */
#ifndef EC_RENDER_COURSE_H
#define EC_RENDER_COURSE_H

#include "film/forecast.h"
#include "device/adaptive.h"
#include "render/clean_goal.h"
#include "render/render.h"
#include "render/sources.h"

/* What a render knows between two waves, beside its film: with both another goes on as if there had been no break. */
typedef struct ec_past {
    uint32_t next;                    /* the index of the next batch, or pass of an adaptive render */
    uint64_t samples, rays;           /* done */
    double seconds;                   /* of rendering */
    uint64_t invalid[EC_STAGE_COUNT]; /* dropped by the kernels, by ec_stage */
    uint32_t under_way;               /* pixels of batch `next`, in the order of its pass, that are done … */
    const float *batch;               /* … and what they came to, EC_BATCH_FIELDS a pixel of the image; NULL: none are */
    const float *features;            /* likewise, EC_FILM_FEATURES a pixel; NULL: the batch has none */
    ec_slope slope;                   /* that the rounds so far show: an allotment goes by it */
    bool allotted;                    /* the pilot of an adaptive render is over, and its allotment is made */
    ec_allotment allotment;           /* weight, gain and level count; without weights sampling stays uniform */
} ec_past;

typedef struct ec_course {
    uint32_t first, end;              /* batches [first, end) of the job; end 0: whatever the limits say … */
    uint32_t cut;                     /* samples that the last of them lacks */
    uint32_t most;                    /* … but not beyond so many samples a pixel; 0: no matter */
    const ec_past *past;              /* of the film that ec_render_course is given; NULL: a new one. Memory is its owner's */
    /* Once the scene is on the device, stats->content is known and before the first sample. Its failure ends the render. NULL: no matter. */
    ec_result (*admit)(void *user, const ec_render_stats *stats, ec_error *err);
    /* Once all of the scene is on the device that renders alone: its data (ec_scene_drop_data) are not looked at any more. NULL: no matter. */
    void (*loaded)(void *user);
    /* Between two waves, every so many seconds, and at the end; once the film has a batch. False where it
     * could not: the render goes on, and tries again. NULL: never. */
    bool (*keep)(void *user, const ec_film *film, const ec_past *past);
    bool past_is_kept;                /* where `keep` keeps: it has no need to before there is more */
    double every;
    /* Where the picture does not fit into memory it is rendered in strips (strips.h): each that is complete, from the top, with its first row
     * and what is known so far; samples are those of strips before it too. Its failure ends the render. The film is then made anew; in the
     * end it is empty, unless there was one strip only, which is not told. NULL: pictures are rendered whole, because of what
     * `whole_for` says, an option as on the command line. */
    ec_result (*strip)(void *user, const ec_film *film, uint32_t first_row, const ec_render_stats *stats, ec_error *err);
    const char *whole_for;
    /* With options.denoise, at some of the rounds: what is the error of the film's clean picture? It may change film->clean. NULL: nobody asks. */
    ec_result (*clean)(void *user, ec_film *film, ec_clean_look *look, ec_error *err);
    const ec_peers *peers;          /* that take batches too; NULL: none */
    void *user;
} ec_course;

/* ec_render by a course, on all of these devices at once (1 to EC_DEVICES_MOST). One that fails is left out with a warning; only when there is
 * none left does the render fail. Host memory beside the film: a batch and its first-hit features, 56 bytes a pixel, with one device, else also ec_team_bytes
 * (team.h). film must be zero-initialised, or with a past hold what was done, at options' size. */
ec_result ec_render_course(ec_cl *devices, uint32_t device_count, const ec_scene *scene,
                           const ec_render_options *options, const ec_course *course, ec_progress_fn progress,
                           void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err);

#endif
