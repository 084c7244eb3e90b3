/* Chooses the exposure that a picture is shown with. */
#ifndef EC_FILM_EXPOSURE_H
#define EC_FILM_EXPOSURE_H

#include "film/film.h"

#define EC_EXPOSURE_MOST 100  /* stops that the program takes, brighter and darker */
#define EC_EXPOSURE_KEY 0.18  /* what auto makes of the log-average luminance: middle grey */

typedef struct ec_exposure {
    double stops; /* radiance is multiplied by 2^stops */
    bool is_auto; /* by the picture instead: Reinhard et al. 2002, equations 1 and 2, over the pixels that are not black */
} ec_exposure;

/* Returns the stops to show a film with; 0 for a black film, where they are auto. */
double ec_exposure_stops(const ec_exposure *exposure, const ec_film *film);

#endif
