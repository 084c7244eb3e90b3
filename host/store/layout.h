/* Layout of a film in an EXR file.
 *
 * Part "picture": what viewers show. Its attribute eclat.state is a JSON object: state.c. Part "sums N" for each part of the film: R, G and B of each
 * replicate, the tail of the samples and each set of features, if it has any (film/sums.h); or the values of a single batch. Pixels with counts of their
 * own have "count" there. Parts "layer K sums N" are the same of the K-th layer, from 1 on; of what light paths bring, where that is apart, K is one more
 * than there are layers. Part "allotment": "weight", by pixel number. Part "under way": the values of the batch that is not complete. */
#ifndef EC_STORE_LAYOUT_H
#define EC_STORE_LAYOUT_H

#include "image/exr_parts.h"
#include "store/store.h"

/* Returns the object as text, malloc'ed; NULL if there is no memory. */
char *ec_state_write(const ec_job *job, const ec_film *film, const ec_past *past);

/* Fills in the job, the past without its arrays, and what must be known of the film before it is read. */
typedef struct ec_state_film {
    uint32_t replicates, batch_count, part_count, cut, feature_sets, feature_end;
    float limit;
    uint64_t invalid_count;
    ec_film_part *parts, *light_parts; /* without sums; malloc'ed */
    uint32_t light_part_count;
    bool has_light;
    bool has_counts, has_weights;
    ec_layers layers;
    ec_rare rare;
} ec_state_film;
ec_result ec_state_read(const char *text, const char *path, ec_stored *stored, ec_state_film *film, ec_error *err);

enum { EC_SUM_CHANNELS = 3 * EC_REPLICATES_MOST + 4 + 2 * EC_FILM_FEATURES, EC_BATCH_CHANNELS = EC_BATCH_FIELDS + EC_FILM_FEATURES };
typedef struct ec_channel_name {
    char text[24];
} ec_channel_name;
/* Lists the channels of sums, and of counts if these are not NULL; returns how many. Their names are stored in `names`. */
uint32_t ec_sum_channels(const ec_sums *sums, const uint32_t *counts, ec_channel_name names[EC_SUM_CHANNELS], ec_channel channels[EC_SUM_CHANNELS]);
/* Likewise for a batch. features: NULL if it has none. */
uint32_t ec_batch_channels(const float *batch, const float *features, ec_channel channels[EC_BATCH_CHANNELS]);

enum { EC_PART_NAME = 40 };
void ec_sum_part_name(uint32_t layer, uint32_t index, char name[EC_PART_NAME]); /* layer 0: the picture */

#endif
