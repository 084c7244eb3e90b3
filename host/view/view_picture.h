/* The film of the camera that rests: batches as `eclat render` takes them, until a limit is met. The renderer's own. */
#ifndef EC_VIEW_VIEW_PICTURE_H
#define EC_VIEW_VIEW_PICTURE_H

#include "render/goal.h"
#include "view/shared.h"

typedef struct ec_view_picture {
    ec_film film;             /* batch_count 0: nothing yet; width 0: not begun */
    ec_render_options limits; /* spp, error_target, time_limit */
    ec_goal goal;
    ec_film_error error;
    double seconds;           /* of batches */
    uint64_t invalid;
    float *room;              /* for a batch */
    const char *stopped_by;   /* NULL: goes on */
} ec_view_picture;

ec_result ec_view_picture_start(ec_view_picture *picture, const ec_render_options *options, uint32_t more,
                                uint32_t width, uint32_t height, ec_error *err);
void ec_view_picture_stop(ec_view_picture *picture); /* zero-initialised is fine */

/* The limits as they are after `more` wishes for more; goes on if they are not met. */
void ec_view_picture_limit(ec_view_picture *picture, const ec_render_options *options, uint32_t more);

/* Samples a pixel so far. */
uint64_t ec_view_picture_samples(const ec_view_picture *picture);

/* One more batch, if go_on lets it: *complete. */
ec_result ec_view_picture_take(ec_view_picture *picture, ec_session *session, bool (*go_on)(void *user), void *user,
                               bool *complete, ec_error *err);

#endif
