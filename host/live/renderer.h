/* The state of the renderer's thread, and the parts of its work: live_film.c, second.c, pixel_probe.c, work.c, save.c. */
#ifndef EC_LIVE_RENDERER_H
#define EC_LIVE_RENDERER_H

#include "live/shared.h"
#include "render/goal.h"

/* The film of the camera that rests: batches as `eclat render` takes them, until a limit is met. */
typedef struct ec_live_film {
    ec_film film;             /* batch_count 0: nothing yet; width 0: not begun */
    ec_render_options limits; /* spp, error_target, time_limit */
    ec_goal goal;
    ec_film_error error;
    double seconds;           /* of batches */
    uint64_t invalid;
    float *room;              /* for a batch */
    const char *stopped_by;   /* NULL: goes on */
    double clean_samples;     /* a pixel, when film.clean was made last; 0: it was not */
    ec_denoised denoised;     /* what came of that */
    char undenoised[320];     /* why there is none; empty: there is, or will be */
} ec_live_film;

ec_result ec_live_film_start(ec_live_film *film, const ec_render_options *options, uint32_t more, uint32_t width, uint32_t height, ec_error *err);
void ec_live_film_stop(ec_live_film *film); /* zero-initialised is fine */

/* The clean picture of its samples, where that is due: anew whenever they have doubled, and in the end; now: in any case. */
void ec_live_film_clean(ec_live_film *film, const ec_device_info *device, bool now);

/* The limits as they are after `more` wishes for more; goes on if they are not met. */
void ec_live_film_limit(ec_live_film *film, const ec_render_options *options, uint32_t more);

/* One more batch, if go_on lets it: *complete. */
ec_result ec_live_film_take(ec_live_film *film, ec_session *session, bool (*go_on)(void *user), void *user, bool *complete, ec_error *err);

/* The picture that can stand beside it: its error, its samples, another integrator's picture, or a file. */
typedef struct ec_live_second {
    float *other;                /* 3 a pixel, of the other integrator; NULL: not rendered of this camera */
    float *fitted;               /* the file, as large as the picture; NULL: not yet shown */
    uint32_t fitted_width, fitted_height;
} ec_live_second;

void ec_live_second_close(ec_live_second *second);
void ec_live_second_forget(ec_live_second *second); /* the camera has moved */

/* The other integrator's, from its session, which looks where the picture does; goes on being NULL where go_on said no. */
ec_result ec_live_second_render(ec_live_second *second, ec_session *session, uint32_t width, uint32_t height, bool (*go_on)(void *user), void *user,
                                ec_error *err);

/* Shows that which is wished, if there is one: *is_there. mean: the film's. */
ec_result ec_live_second_show(ec_live_second *second, ec_live *live, const eclat_wish *wish, const ec_film *film, const float *mean, bool *is_there,
                              ec_error *err);

typedef struct ec_renderer {
    ec_live *live;
    ec_live_setup *setup[ECLAT_SHOWN_COUNT];
    eclat_wish wish;            /* that is being worked at */
    uint32_t serial;            /* its */
    ec_camera camera;
    uint32_t level;             /* pixels of a side for a sample; 0: the film's turn */
    uint32_t previews;
    bool aside;                 /* the session looks where a preview was taken, not where the film is */
    bool dirty;                 /* the film's picture is to be shown (again) */
    bool broken;                /* camera or device failed: waits for another */
    bool looked_away;           /* the probe was of another camera */
    ec_live_film picture;
    ec_live_second second;
    float *mean;                /* 3 a pixel, of room pixels */
    uint64_t room;
    uint32_t saves;             /* that are done, or given up */
    int saved;                  /* pictures */
} ec_renderer;

/* pixel_probe.c: pixel, surface and node under the wish's pixel, and where was picked last; as far as that is not known */
void ec_renderer_probe(ec_renderer *r, const ec_live_asked *asked);
void ec_renderer_read_pixel(const ec_film *film, eclat_probe *probe); /* anew, as the film goes on */

/* work.c: steps of work, each as long as a wave where nobody waits for it */
ec_result ec_renderer_start_afresh(ec_renderer *r, ec_error *err); /* what the next look shows is another picture */
ec_result ec_renderer_preview(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_batch(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_second(ec_renderer *r, ec_error *err); /* the other integrator */
ec_result ec_renderer_show(ec_renderer *r, ec_error *err);

/* save.c: what the last save asked for, as soon as there is a film of it, whatever is wished since; given up where there will be none. */
void ec_renderer_serve_save(ec_renderer *r, const ec_live_asked *asked);

#endif
