/* What can stand beside the picture: its error, its samples, another rung, another file. */
#ifndef EC_VIEW_SECOND_H
#define EC_VIEW_SECOND_H

#include "view/shared.h"

typedef struct ec_view_others {
    float *rung;                 /* 3 a pixel, of the other rung; NULL: not rendered of this camera */
    float *file;                 /* --against */
    float *fitted;               /* the same, as large as the picture; NULL: not yet shown */
    uint32_t file_width, file_height, fitted_width, fitted_height;
} ec_view_others;

/* against: an EXR that was read before without complaint, or NULL. */
void ec_view_others_open(ec_view_others *others, const char *against);
void ec_view_others_close(ec_view_others *others);
void ec_view_others_forget(ec_view_others *others); /* the camera has moved */

/* The rung from its session, which looks where the picture does; goes on being NULL where go_on said no. */
ec_result ec_view_others_render(ec_view_others *others, ec_session *session, uint32_t width, uint32_t height,
                                bool (*go_on)(void *user), void *user, ec_error *err);

/* Is there one? An error takes two batches. */
bool ec_view_others_has(const ec_view_others *others, ec_view_second second, const ec_film *film);

/* That which is wished, as far as there is one; mean: the film's. false: ask again. */
bool ec_view_others_show(ec_view_others *others, ec_view *view, const ec_view_wish *wish, const ec_film *film, const float *mean);

#endif
