/* Which samples a batch has.
 *
 * A picture is rendered as R replicates: copies of the sample sequence with independent randomisations, each extended for as long as
 * the render goes on (L'Ecuyer, Nakayama, Owen, Tuffin 2023, "Confidence intervals for randomized quasi-Monte Carlo estimators").
 * Batch k is a range of samples of one replicate, in all pixels. Batches go by strides: stride j is samples [start(j), start(j + 1)) of
 * each replicate in turn, so batch k is stride k / R of replicate k % R. Strides end at 1, 2, 4, 8, then at every quarter of a power of
 * two (8, 10, 12, 14, 16, 20, …) up to 512, then at every 64th sample. The same for every job: a picture's bits depend on how many
 * samples it has, not on the limit that ended it.
 *
 * A round ends where all replicates have equally many samples: 1, 2, 4, 8 or a quarter of a power of two. There limits of error are looked at;
 * between two rounds nothing is decided. */
#ifndef EC_FILM_SCHEDULE_H
#define EC_FILM_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

#define EC_REPLICATES 4          /* R by default: docs/sampling.md says what others cost */
#define EC_REPLICATES_DENOISED 8 /* with a denoiser: its result of one half is judged by the other */
#define EC_REPLICATES_MOST 16
#define EC_BATCH_MOST 64u        /* samples of a batch */
#define EC_FEATURE_SAMPLES 8u    /* samples of a pixel that first-hit features are averaged over: so many or more, in whole strides */
#define EC_PILOT_SAMPLES 32u     /* of a pixel: before these no error is judged, … */
#define EC_PILOT_LEAST 4u        /* … nor before so many of each replicate */

typedef struct ec_batch_range {
    uint32_t replicate;
    uint32_t samples;          /* 1 to EC_BATCH_MOST */
    uint64_t first;            /* number of the first one within the replicate */
} ec_batch_range;
ec_batch_range ec_schedule_batch(uint32_t replicates, uint32_t index);

/* Returns the samples a pixel of all batches before this one. */
uint64_t ec_schedule_samples(uint32_t replicates, uint32_t index);

/* Returns the samples that batches [first, end) have of one replicate. */
uint64_t ec_schedule_share(uint32_t replicates, uint32_t replicate, uint64_t first, uint64_t end);

/* Returns the batch that has sample number `samples` of a pixel; *before: how many samples come before it in that batch. 0 where so many samples are
 * whole batches, whose number is then returned. */
uint32_t ec_schedule_find(uint32_t replicates, uint64_t samples, uint32_t *before);

/* Returns the first end of a round after more than `index` batches, as a number of batches. */
uint64_t ec_schedule_round(uint32_t replicates, uint64_t index);

/* Returns whether so many batches end a round. */
bool ec_schedule_is_round(uint32_t replicates, uint64_t index);

/* Returns how many samples a replicate of `has` samples gets in its next stride. */
uint32_t ec_schedule_step(uint64_t has);

/* Returns how many batches first-hit features are averaged over, if they are only to be shown. */
static inline uint32_t ec_schedule_features(uint32_t replicates)
{
    uint32_t batches = replicates;
    while (ec_schedule_samples(replicates, batches) < EC_FEATURE_SAMPLES) batches += replicates;
    return batches;
}

/* Returns how many samples each replicate needs before an error is judged. */
static inline uint32_t ec_schedule_pilot(uint32_t replicates)
{
    const uint32_t share = (EC_PILOT_SAMPLES + replicates - 1) / replicates;
    return share > EC_PILOT_LEAST ? share : EC_PILOT_LEAST;
}

/* Returns whether so many batches are enough to judge an error by. */
static inline bool ec_schedule_has_pilot(uint32_t replicates, uint64_t batches)
{
    return ec_schedule_share(replicates, replicates - 1, 0, batches) >= ec_schedule_pilot(replicates);
}

#endif
