/* The devices of a render as one source of batches: a device alone, or a team of them that are loaded from one cargo. */
#ifndef EC_PIPELINE_SOURCES_H
#define EC_PIPELINE_SOURCES_H

#include <pthread.h>

#include "pipeline/cargo.h"
#include "pipeline/device_source.h"
#include "pipeline/team.h"

typedef struct ec_source_recruit {
    struct ec_sources *all;
    ec_cl *cl;
    ec_device_source source;
    ec_render_stats stats;            /* what its set-up says */
} ec_source_recruit;

typedef struct ec_sources {
    ec_cargo cargo;
    ec_cl *devices;
    uint32_t count;
    uint64_t seed;
    ec_source_recruit *recruits;      /* as many */
    ec_team *team;                    /* NULL: one device alone */
    pthread_mutex_t lock;
    uint32_t unloaded;                /* that have not taken what they want of the cargo */
} ec_sources;

/* Makes the cargo, for these devices. To be closed on failure too. */
ec_result ec_sources_pack(ec_cl *devices, uint32_t count, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                          ec_sources *sources, ec_render_stats *stats, ec_error *err);

/* Loads them: one alone before it returns, several by threads of their own. *source is valid until they are closed. */
ec_result ec_sources_open(ec_sources *sources, uint64_t seed, const ec_log *log, ec_batch_source **source, ec_render_stats *stats, ec_error *err);

/* stats gets what is known of the devices then. */
void ec_sources_close(ec_sources *sources, ec_render_stats *stats);

#endif
