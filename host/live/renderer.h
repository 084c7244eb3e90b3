/* What the renderer's thread works at, and the parts of its work: pixel_probe.c, work.c, save.c. */
#ifndef EC_LIVE_RENDERER_H
#define EC_LIVE_RENDERER_H

#include "live/live_film.h"
#include "live/second.h"
#include "live/shared.h"

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
