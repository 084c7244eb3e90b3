/* A source of batches: a device, a team of them, or whatever else has these functions. A source knows no film, no limits and no other
 * source; a batch's numbers depend on its index alone, so that any source may take any batch, or any piece of one. */
#ifndef EC_DEVICE_BATCH_SOURCE_H
#define EC_DEVICE_BATCH_SOURCE_H

#include "base/error.h"
#include "film/matte_log.h"
#include "film/sums.h"
#include "device/options.h"
#include "device/stats.h"
#include "shared/path_state.h"

#define EC_TILE_ROWS 8u /* kernels/lib/film.h */

/* Most positions of an order: the number of pixels, or so many for a pass of an adaptive render of a small picture, since short passes cost what
 * their launches do. */
#define EC_PASS_POSITIONS (1u << 18)
static inline uint64_t ec_order_positions(uint64_t pixels, uint32_t replicates)
{
    const uint64_t all = pixels * replicates, most = all < EC_PASS_POSITIONS ? all : EC_PASS_POSITIONS;
    return pixels > most ? pixels : most;
}

/* The part of light paths in an order, if there are any. */
typedef enum ec_order_light {
    EC_LIGHT_ADDED, /* what they bring is part of the batch */
    EC_LIGHT_APART, /* it is not … */
    EC_LIGHT_ALONE  /* … and this order is for that alone, as a batch of as many samples; no path starts at the camera */
} ec_order_light;

/* Positions done to count - 1 of a batch. A position is a place in `list` or, without one, a pixel number; then both ends of what is not a whole
 * batch are whole rows of tiles (kernels/lib/film.h), whose numbers and places in row order are the same range. */
typedef struct ec_batch_order {
    ec_order_light light;
    uint32_t index;                   /* of the batch, in the whole job: film/schedule.h says which samples it is */
    uint32_t cut;                     /* samples that are not wanted at its end */
    /* Batches before this one will be ordered next if no limit is met, and may be begun: all pixels of each or, where `batches` is set, the same
     * positions, and as many at once. */
    uint32_t end;
    /* A block: so many batches from `index` on, EC_FILM_FIRST or 16 times that and index a multiple of it, whose sums are wanted in place of single
     * batches. 1: no block. 0: no block, or what is chosen by `whole`. */
    uint32_t batches;
    /* Returns how many batches from this or a later one on are wanted in any case, all pixels of each, without a look at what is there in between: a
     * source may take a block of its own accord. Gives always the same answer, to any thread. NULL: one. */
    uint32_t (*whole)(const void *user, uint32_t index);
    double patience, until;           /* … if the block is predicted to end within so many seconds, and by then (base/clock.h) */
    double left;                      /* samples from `done` on in all that limits of samples allow; INFINITY: any number */
    const uint32_t *list;             /* of one pass of an adaptive render, EC_LIST_WORDS an entry; NULL: all pixels */
    uint32_t samples;                 /* of each of its entries */
    float limit;                      /* ec_params.limit: the same for all samples of a picture */
    uint32_t count, done;
    const float *before, *features_before; /* what the done positions came to, EC_BATCH_FIELDS and EC_AOV_FIELDS a position; NULL: held elsewhere, or
                                            * none */
    float *into;                      /* room for EC_BATCH_FIELDS of each position from `done` on; NULL: where `mean` is, the source's own */
    const ec_sums *sums;              /* the same for a block; NULL: the source's own */
    uint32_t feature_sets;            /* of first-hit features (film/sums.h) that come with the batches; 0: none are wanted */
    float *features_into;             /* room for EC_AOV_FIELDS of each position from `done` on, where there is `into`; NULL: where `features` is */
    float *layers;                    /* room for three floats a layer of all positions; NULL: no layers are wanted */
    ec_matte_log *matte;              /* takes what samples meet; NULL: not wanted */
    /* Asked between waves, with the number of positions that are done, the first time when the device has done them; false gives the batch up. */
    bool (*go_on)(void *user, uint32_t done);
    void *user;
} ec_batch_order;

/* Value of mean[EC_BATCH_FIELDS i] for a pixel that batch 0, given up, has not reached: radiance is never negative. */
#define EC_NOT_REACHED (-1.0f)

typedef struct ec_batch_source ec_batch_source;
struct ec_batch_source {
    /* Takes an order. *complete: false where go_on said no; positions not reached then hold anything, of batch 0 EC_NOT_REACHED if they are before
     * `reached`. */
    ec_result (*take)(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err);
    /* To be called from go_on alone: sets mean to what the batch under way has come to so far, and updates features, rays and invalid. */
    ec_result (*look)(ec_batch_source *source, const ec_batch_order *order, ec_error *err);
    /* Says which rows of the picture the next orders are of; positions count from the first of them. NULL: all, always. */
    ec_result (*turn_to)(ec_batch_source *source, uint32_t first_row, uint32_t rows, ec_error *err);
    /* No order until the next turn_to wants features: frees their memory. NULL: the source has none of its own. */
    ec_result (*end_features)(ec_batch_source *source, ec_error *err);
    void (*close)(ec_batch_source *source); /* rays, invalid and other figures stay */
    uint32_t batches;                 /* number of batches of the order under way, or of the last one; known when go_on is called */
    float *mean;                      /* EC_BATCH_FIELDS a position: the batch taken last, until the next one is. That of one given up may be written */
    uint32_t reached;                 /* nothing of batch 0, given up, is there from this place on */
    float *features;                  /* of that batch likewise, EC_AOV_FIELDS a position, where they were wanted and had no room */
    ec_sums sums;                     /* of the block taken last, from order->done on; owned, until somebody takes it (and sets zeros) */
    uint64_t rays;                    /* traced so far */
    double clocked_seconds, clocked_rays; /* of launches that were clocked, if any were */
    uint32_t invalid[EC_STAGE_COUNT]; /* samples dropped in batches taken so far, by ec_stage */
    uint32_t least;                   /* number of positions under which an order is not worth its launches; 0: any */
};

#endif
