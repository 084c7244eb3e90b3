/* State that the pictures of one job share: devices, an environment, acceleration structures. */
#ifndef EC_JOBS_FRAME_SHARE_H
#define EC_JOBS_FRAME_SHARE_H

#include "accel/follow.h"
#include "cl/cl.h"
#include "device/stats.h"
#include "gltf/reader.h"
#include "jobs/outputs.h"
#include "pack/pack.h"

/* Paths of files that were written. Zero-initialised: none. */
typedef struct ec_paths {
    char **list; /* owned */
    uint32_t count;
} ec_paths;

/* Data that the pictures of one job share. */
typedef struct ec_frame_share {
    ec_animation *animation;     /* of a sequence of frames; NULL: the pictures have different scenes */
    ec_device_info devices[EC_DEVICES_MOST];
    uint32_t device_indices[EC_DEVICES_MOST], device_count;
    const char *device_why;
    ec_cl cl[EC_DEVICES_MOST];   /* the devices, once they are open */
    bool is_open;
    ec_followed followed;        /* acceleration structures of the animation */
    ec_environment environment;  /* that of all frames, or of all pictures with this key, set by the first of them; owns its picture */
    char environment_key[400];
    ec_packed_map packed;        /* of the environment's picture */
    bool has_environment, environment_known;
    ec_paths pictures;           /* one file of each picture that exists */
} ec_frame_share;

void ec_frame_share_close(ec_frame_share *share); /* closes the devices; the next picture opens them anew */
void ec_frame_share_leave(ec_frame_share *share); /* frees what belongs to one scene, and the environment */
void ec_frame_share_drop_environment(ec_frame_share *share);
void ec_frame_share_free(ec_frame_share *share);  /* frees everything */
/* Remembers one of these files, a PNG if there is one, as a picture that exists; leaves it out if there is no memory. */
void ec_frame_share_picture(ec_frame_share *share, const ec_outputs *outputs);

#endif
