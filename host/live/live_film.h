/* The film of the camera that rests: batches as `eclat render` takes them, until a limit is met. The renderer's own. */
#ifndef EC_LIVE_LIVE_FILM_H
#define EC_LIVE_LIVE_FILM_H

#include "live/shared.h"
#include "render/goal.h"

typedef struct ec_live_film {
    ec_film film;             /* batch_count 0: nothing yet; width 0: not begun */
    ec_render_options limits; /* spp, error_target, time_limit */
    ec_goal goal;
    ec_film_error error;
    double seconds;           /* of batches */
    uint64_t invalid;
    float *room;              /* for a batch */
    const char *stopped_by;   /* NULL: goes on */
} ec_live_film;

ec_result ec_live_film_start(ec_live_film *film, const ec_render_options *options, uint32_t more, uint32_t width, uint32_t height, ec_error *err);
void ec_live_film_stop(ec_live_film *film); /* zero-initialised is fine */

/* The limits as they are after `more` wishes for more; goes on if they are not met. */
void ec_live_film_limit(ec_live_film *film, const ec_render_options *options, uint32_t more);

/* One more batch, if go_on lets it: *complete. */
ec_result ec_live_film_take(ec_live_film *film, ec_session *session, bool (*go_on)(void *user), void *user, bool *complete, ec_error *err);

#endif
