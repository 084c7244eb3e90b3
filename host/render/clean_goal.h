/* Decides how long a render goes on whose error is to be that of its denoised picture. */
#ifndef EC_RENDER_CLEAN_GOAL_H
#define EC_RENDER_CLEAN_GOAL_H

#include <stdbool.h>

/* A clean picture's error, and the upper end of its 95 % interval: infinite where it is not known. */
typedef struct ec_clean_look {
    double error, high95;
} ec_clean_look;

/* The looks so far. Zero-initialised: none. */
typedef struct ec_clean_goal {
    double samples, last_samples;  /* a pixel, at the last look and the one before it; 0: there was none */
    ec_clean_look now, last;
} ec_clean_goal;

/* Returns whether a look is due after so many samples a pixel. Each costs seconds: it is due whenever samples have doubled, and where the error could
 * be under `target` if it fell twice as fast as noise does. This goes by samples alone, so that a picture ends at the same sample on any machine. */
bool ec_clean_goal_is_due(const ec_clean_goal *goal, double samples, double target);

void ec_clean_goal_take(ec_clean_goal *goal, double samples, const ec_clean_look *look);

/* Samples a pixel until high95 is under `target`, with a 95 % interval; infinite where nothing is known. */
typedef struct ec_clean_range {
    double low, expected, high;
} ec_clean_range;
ec_clean_range ec_clean_goal_samples(const ec_clean_goal *goal, double target);

/* Returns high95 after so many samples a pixel. */
double ec_clean_goal_bound(const ec_clean_goal *goal, double samples);

#endif
