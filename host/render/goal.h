/* The goal of a render, how far it is, and when it will be there: limits, pace and forecast, for renders and previews alike. */
#ifndef EC_RENDER_GOAL_H
#define EC_RENDER_GOAL_H

#include <stdbool.h>

#include "film/forecast.h"
#include "render/clean_goal.h"

/* A point of a render: samples a pixel in the mean, and seconds of rendering. */
typedef struct ec_mark {
    double samples, seconds;
} ec_mark;

typedef struct ec_goal {
    double samples;                     /* a pixel; 0: no limit */
    double seconds;                     /* of rendering; 0: no limit */
    double error;                       /* of the bound; 0: no limit */
    double pixels;
    uint32_t replicates;
    ec_mark first, recent[2];           /* the first batch, in which compilers take part; marks a quarter to a half of the way back */
    double took, squares, timed;        /* sums over batches but the first: seconds, seconds^2 a sample, samples */
    ec_slope slope;
    ec_film_error now;                  /* of the last round */
    ec_clean_goal clean;                /* the clean picture's looks, to which the error's limit applies too */
    bool is_withheld;                   /* the error's limit would be met, if there were a bound */
    ec_forecast forecast, pilot;        /* the present one; the first one */
    double told;                        /* what ec_goal_fraction said last */
} ec_goal;

/* Sets limits as options give them, 0: none. */
void ec_goal_set(ec_goal *goal, double samples, double seconds, double error);

/* Notes that a batch is done, which took `took` seconds itself. */
void ec_goal_batch(ec_goal *goal, double samples, double seconds, double took);

/* Forgets the pace of the batches so far, which says nothing of those to come, as where slower kernels took part (device/tiers.h). */
void ec_goal_restart_pace(ec_goal *goal);

/* Notes that a round is done, and the film's error. */
void ec_goal_round(ec_goal *goal, const ec_film_error *now, ec_mark at);

/* Makes a forecast, once the pilot is over; gain: what error^2 will be multiplied by from here on. */
void ec_goal_predict(ec_goal *goal, ec_mark at, double gain);

/* Returns which limit is met: "spp", "error" or "time"; NULL: none. may_judge: a round has ended, and the pilot is over; next: samples a pixel that
 * would be taken next. */
const char *ec_goal_met(const ec_goal *goal, ec_mark at, bool may_judge, double next);

/* Returns how much is done, 0 to 1, of what the first limit will take; never less than before, though a later forecast may be longer. */
double ec_goal_fraction(ec_goal *goal, ec_mark at);
double ec_goal_seconds_left(const ec_goal *goal, ec_mark at); /* < 0: not known */

#endif
