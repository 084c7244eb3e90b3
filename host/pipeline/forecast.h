/* When will a render be done? */
#ifndef EC_PIPELINE_FORECAST_H
#define EC_PIPELINE_FORECAST_H

#include "pipeline/render.h"

/* What is known of a render under way. */
typedef struct ec_pace {
    double seconds;        /* of rendering, so far */
    double first_seconds;  /* of these, the first batch: compilers and caches slow it down */
    double spread;         /* relative standard deviation of the batches' times, the first left out; 0 where there is one only */
} ec_pace;

/* Fewer batches cannot tell a pixel's variance from its kurtosis. */
bool ec_pilot_is_over(uint32_t batches);

/* now: the film's error. done: batches a pixel, in the mean. gain: what the variance will be multiplied by from here on. limits: spp, error and time of the options; whichever is expected first. */
ec_forecast ec_forecast_make(const ec_film *film, const ec_film_error *now, const ec_render_options *limits,
                             const ec_pace *pace, double done, double gain);

#endif
