/* The film of the camera that rests: batches as `eclat render` takes them, until a limit is met. The renderer's own. */
#ifndef EC_VIEW_PICTURE_H
#define EC_VIEW_PICTURE_H

#include "view/shared.h"

typedef struct ec_view_picture {
    ec_film film;             /* batch_count 0: nothing yet */
    ec_render_options limits; /* batch, spp, error_target, time_limit */
    ec_film_error error;
    ec_forecast forecast;
    double seconds, first_seconds, sum, squares; /* of batches; as ec_pace wants them */
    uint64_t invalid;
    const char *stopped_by;   /* NULL: goes on */
} ec_view_picture;

/* rate: samples a second, as far as known: a batch takes about as long as one likes to wait for the next picture. */
ec_result ec_view_picture_start(ec_view_picture *picture, const ec_render_options *options, uint32_t more,
                                uint32_t width, uint32_t height, double rate, ec_error *err);
void ec_view_picture_stop(ec_view_picture *picture); /* zero-initialised is fine */

/* The limits as they are after `more` wishes for more; goes on if they are not met. */
void ec_view_picture_limit(ec_view_picture *picture, const ec_render_options *options, uint32_t more);

/* One more batch, if go_on lets it: *complete. */
ec_result ec_view_picture_take(ec_view_picture *picture, ec_session *session, bool (*go_on)(void *user), void *user, float *mean,
                               bool *complete, ec_error *err);

#endif
