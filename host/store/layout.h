/* How a film lies in an EXR file.
 *
 * Part "picture": what viewers show; first-hit features are read from its channels A, albedo, normal and depth. Its attribute eclat.state
 * is a JSON object: state.c. Part "sums N" for each part of the film: mean, m2 (doubles, as two integers each), m3, m4 and largest; or for a
 * single batch R, G and B. Pixels with counts of their own have "count" there. Part "allotment": "weight", by pixel number. Part
 * "under way": R, G and B of the batch that is not complete. */
#ifndef EC_STORE_LAYOUT_H
#define EC_STORE_LAYOUT_H

#include "image/exr_parts.h"
#include "store/store.h"

/* The object as text, malloc'ed; NULL where there is no memory. */
char *ec_state_write(const ec_job *job, const ec_film *film, const ec_past *past);

/* Fills the job, the past but for its arrays, and what is to be known of the film before it is read. */
typedef struct ec_state_film {
    uint32_t samples_per_batch, batch_count, part_count;
    uint64_t invalid_count;
    ec_film_part *parts; /* without sums; malloc'ed */
    bool has_counts, has_weights;
} ec_state_film;
ec_result ec_state_read(const char *text, const char *path, ec_stored *stored, ec_state_film *film, ec_error *err);

enum { EC_SUM_CHANNELS = 18 };
/* Channels of sums, and of counts where they are not NULL. */
uint32_t ec_sum_channels(const ec_moments *sums, const uint32_t *counts, ec_channel channels[EC_SUM_CHANNELS]);
uint32_t ec_batch_channels(const float *batch, ec_channel channels[3]);
/* Of features, 8 floats a pixel: names and order of those in the picture. */
enum { EC_FEATURE_CHANNELS = 8 };
extern const char *const ec_feature_channels[EC_FEATURE_CHANNELS];

void ec_sum_part_name(uint32_t index, char name[24]);

#endif
