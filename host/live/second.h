/* What can stand beside the picture: its error, its samples, another integrator's picture, a file. */
#ifndef EC_LIVE_SECOND_H
#define EC_LIVE_SECOND_H

#include "live/shared.h"

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

#endif
