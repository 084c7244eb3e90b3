/* The state of the renderer's thread, and the parts of its work: live_film.c, second.c, pixel_probe.c, work.c, save.c. */
#ifndef EC_LIVE_RENDERER_H
#define EC_LIVE_RENDERER_H

#include "live/shared.h"
#include "render/goal.h"

/* The film of a camera at rest: batches as `eclat render` takes them, until a limit is met. */
typedef struct ec_live_film {
    ec_film film;             /* batch_count 0: nothing yet; width 0: not begun */
    ec_render_options limits; /* spp, error_target, time_limit */
    ec_goal goal;
    ec_film_error error;
    double seconds;           /* taken by batches */
    uint64_t invalid;
    float *room;              /* for a batch */
    const char *stopped_by;   /* NULL: it goes on */
    double clean_samples;     /* samples per pixel when film.clean was last made; 0: never */
    ec_denoised denoised;     /* its result */
    char undenoised[320];     /* why there is none; empty: there is one, or will be */
} ec_live_film;

ec_result ec_live_film_start(ec_live_film *film, const ec_render_options *options, uint32_t more, uint32_t width, uint32_t height, ec_error *err);
void ec_live_film_stop(ec_live_film *film); /* zero-initialised is fine */

/* Denoises the film if that is due: whenever its samples have doubled, and at the end; now: in any case. */
void ec_live_film_clean(ec_live_film *film, const ec_device_info *device, bool now);

/* Sets the limits, raised `more` times; the film goes on if they are not met. */
void ec_live_film_limit(ec_live_film *film, const ec_render_options *options, uint32_t more);

/* Takes another batch, unless go_on stops it: *complete. */
ec_result ec_live_film_take(ec_live_film *film, ec_session *session, bool (*go_on)(void *user), void *user, bool *complete, ec_error *err);

/* The second picture: the error, the samples, another integrator's picture, or a file. */
typedef struct ec_live_second {
    float *other;                /* 3 per pixel, by the other integrator; NULL: not rendered with this camera */
    float *fitted;               /* the file, resampled to the picture's size; NULL: not shown yet */
    uint32_t fitted_width, fitted_height;
} ec_live_second;

void ec_live_second_close(ec_live_second *second);
void ec_live_second_forget(ec_live_second *second); /* called when the camera has moved */

/* Renders the other integrator's picture with its session, which looks where the first one does; second->other stays NULL if go_on stopped it. */
ec_result ec_live_second_render(ec_live_second *second, ec_session *session, uint32_t width, uint32_t height, bool (*go_on)(void *user), void *user,
                                ec_error *err);

/* Shows the second picture of the view, if it is available: *is_there. mean: the film's. */
ec_result ec_live_second_show(ec_live_second *second, ec_live *live, const eclat_view_request *view, const ec_film *film, const float *mean, bool *is_there,
                              ec_error *err);

typedef struct ec_renderer {
    ec_live *live;
    ec_live_setup *setup[ECLAT_SHOWN_COUNT];
    eclat_view_request view;    /* being worked on */
    uint32_t serial;            /* of that view */
    ec_camera camera;
    uint32_t level;             /* side in pixels of the square for a sample; 0: it is the film's turn */
    uint32_t previews;
    bool aside;                 /* the session's camera is that of a preview, not the film's */
    bool dirty;                 /* the film's picture has to be shown (again) */
    bool broken;                /* camera or device failed: waits for another one */
    bool looked_away;           /* the probe was made with another camera */
    ec_live_film picture;
    ec_live_second second;
    float *mean;                /* 3 per pixel, for `room` pixels */
    uint64_t room;
    uint32_t saves;             /* done or given up */
    int saved;                  /* number of pictures written */
} ec_renderer;

/* pixel_probe.c: updates surface and node under the view's pixel, and answers the last pick, if these are not known yet */
void ec_renderer_probe(ec_renderer *r, const ec_live_asked *asked);
void ec_renderer_read_pixel(const ec_film *film, eclat_probe *probe); /* reads the value again, as the film goes on */

/* work.c: steps of work, each no longer than a wave unless nobody waits for it */
ec_result ec_renderer_start_afresh(ec_renderer *r, ec_error *err); /* called when the picture becomes another one */
ec_result ec_renderer_preview(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_batch(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_second(ec_renderer *r, ec_error *err); /* the other integrator */
ec_result ec_renderer_show(ec_renderer *r, ec_error *err);

/* save.c: saves what was last asked for as soon as its film has samples, whatever is requested since; gives up if it never will. */
void ec_renderer_serve_save(ec_renderer *r, const ec_live_asked *asked);

#endif
