/* What the renderer's thread works at, and the parts of its work: probe.c, work.c, save.c. Internal to view/. */
#ifndef EC_VIEW_RENDERER_H
#define EC_VIEW_RENDERER_H

#include "view/view_picture.h"
#include "view/second.h"

typedef struct ec_renderer {
    ec_view *view;
    ec_view_setup *setup[EC_ROLE_COUNT];
    ec_view_wish wish;          /* that is being worked at */
    ec_camera camera;
    uint32_t level;             /* pixels of a side for a sample; 0: the film's turn */
    uint32_t previews;
    bool aside;                 /* the session looks where a preview was taken, not where the film is */
    bool dirty;                 /* the film's picture is to be shown (again) */
    bool broken;                /* camera or device failed: waits for another */
    bool looked_away;           /* the probe was of another camera */
    ec_view_picture picture;
    ec_view_others others;
    float *mean;                /* 3 a pixel, of room pixels */
    uint64_t room;
    uint32_t saves;
} ec_renderer;

bool ec_view_same_camera(const ec_view_wish *a, const ec_view_wish *b);

/* probe.c: pixel, surface and node under the cursor, and under the last click; as far as that is not known */
void ec_renderer_probe(ec_renderer *r, const ec_view_wish *wish);
void ec_renderer_read_pixel(const ec_film *film, ec_view_probe *probe); /* anew, as the film goes on */

/* work.c: steps of work, each as long as a wave where nobody waits for it */
ec_result ec_renderer_start_afresh(ec_renderer *r, ec_error *err); /* what the next look shows is another picture */
ec_result ec_renderer_preview(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_batch(ec_renderer *r, ec_error *err);
ec_result ec_renderer_take_second(ec_renderer *r, ec_error *err); /* the other rung */
void ec_renderer_show(ec_renderer *r);

/* save.c: what the last S asked for, as soon as there is a film of it, whatever is wished since; given up where there will be none. */
void ec_renderer_serve_save(ec_renderer *r, const ec_view_wish *now, const ec_view_wish *asked);

#endif
