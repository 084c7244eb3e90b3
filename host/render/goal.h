/* What a render is to reach, how far it is, and when it will be there: limits, pace and forecast, for whoever takes batches. */
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
    ec_mark first, recent[2];           /* the first batch, in which compilers take part; a quarter to a half of the way back */
    double took, squares, timed;        /* of batches but for the first: seconds, seconds^2 a sample, samples */
    ec_slope slope;
    ec_film_error now;                  /* of the last round */
    ec_clean_goal clean;                /* the error's limit is the clean picture's too */
    bool is_withheld;                   /* the error's limit would be met, if there were a bound */
    ec_forecast forecast, pilot;        /* of now; the first one */
    double told;                        /* what ec_goal_fraction said last */
} ec_goal;

/* Limits as options have them, 0: none. */
void ec_goal_set(ec_goal *goal, double samples, double seconds, double error);

/* A batch is done; `took` seconds of it were its own. */
void ec_goal_batch(ec_goal *goal, double samples, double seconds, double took);

/* The batches so far say nothing of the pace of those to come, as where slower kernels took part (device/tiers.h). */
void ec_goal_restart_pace(ec_goal *goal);

/* A round is done, and the film has so much error. */
void ec_goal_round(ec_goal *goal, const ec_film_error *now, ec_mark at);

/* Makes a forecast; gain: what error^2 will be multiplied by from here on. To be asked once the pilot is over. */
void ec_goal_foretell(ec_goal *goal, ec_mark at, double gain);

/* Which limit is met: "spp", "error" or "time"; NULL: none. may_judge: a round has ended, and the pilot is over; next: samples a pixel of
 * what would be done next. */
const char *ec_goal_met(const ec_goal *goal, ec_mark at, bool may_judge, double next);

/* How much is done, 0 to 1, of what the first limit will take; never less than it said before, though a later forecast may be longer. */
double ec_goal_fraction(ec_goal *goal, ec_mark at);
double ec_goal_seconds_left(const ec_goal *goal, ec_mark at); /* < 0: not known */

#endif
