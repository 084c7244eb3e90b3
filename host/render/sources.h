/* The devices of a render as one source of batches: one device alone, or a team of devices that are loaded from one payload. */
#ifndef EC_RENDER_SOURCES_H
#define EC_RENDER_SOURCES_H

#include <pthread.h>

#include "device/payload.h"
#include "device/device_source.h"
#include "render/team.h"

/* Sources beside the devices, as the other processes of an MPI job are. */
typedef struct ec_peers {
    uint32_t count;                   /* at most */
    /* Called when the payload is made, and whole, to give it to the peers. A failure ends the render. */
    ec_result (*send)(void *user, const ec_payload *payload, uint64_t seed, const ec_log *log, ec_error *err);
    /* Called after that; false: number i does not take part. */
    bool (*candidate)(void *user, uint32_t i, ec_team_candidate *candidate);
    uint64_t (*received)(void *user); /* returns the bytes that have come from them, ever; NULL: not known */
    void *user;
} ec_peers;

typedef struct ec_source_candidate {
    struct ec_sources *all;
    ec_cl *cl;
    ec_device_source source;
    ec_render_stats stats;            /* filled in by its set-up */
} ec_source_candidate;

typedef struct ec_sources {
    ec_payload payload;
    ec_cl *devices;
    uint32_t count;
    uint64_t seed;
    ec_source_candidate *candidates;      /* one for each device */
    ec_team *team;                    /* NULL: one device alone */
    pthread_mutex_t lock;
    uint32_t unloaded;                /* devices that have not taken what they need of the payload */
    uint32_t peer_members;                  /* members of the team behind the devices … */
    uint32_t peer_processes;        /* … and how many processes they stand for */
    ec_peers peers;
    uint64_t received_before;
} ec_sources;

/* The first step, if the payload is there already: enlists devices, with so many lanes (0: whatever suits each). To be closed on failure too. */
ec_result ec_sources_enlist(ec_cl *devices, uint32_t count, uint32_t lanes, ec_sources *sources, ec_render_stats *stats,
                            ec_error *err);

/* The first step, if it is not: also makes the payload, for these devices, and any others if for_all. */
ec_result ec_sources_pack(ec_cl *devices, uint32_t count, bool for_all, const ec_scene *scene,
                          const ec_render_options *options, uint32_t batch, ec_sources *sources, ec_render_stats *stats,
                          ec_error *err);

/* Loads the devices: one alone before it returns, to be turned to its rows; several in threads of their own, and always for whole pictures. peers may
 * be NULL. *source is valid until the sources are closed. */
ec_result ec_sources_open(ec_sources *sources, uint64_t seed, const ec_peers *peers, const ec_log *log, ec_batch_source **source,
                          ec_render_stats *stats, ec_error *err);

/* Returns the pipeline of a device that is alone, once it is loaded; NULL: there are several. */
const ec_pipeline *ec_sources_alone(const ec_sources *sources);

/* Returns the pipeline of a device, also of one of several, while nothing is ordered; NULL: it is not loaded (yet, unless `waits`). */
ec_pipeline *ec_sources_pipeline(ec_sources *sources, uint32_t device, bool waits);

/* Closes the sources; stats gets what is known of the devices then. */
void ec_sources_close(ec_sources *sources, ec_render_stats *stats);

#endif
