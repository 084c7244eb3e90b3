/* A scene set up once, from which batches of any size are taken one at a time: for measuring, where ec_render's
 * set-up for each number of samples would cost more than the samples. */
#ifndef EC_RENDER_SESSION_H
#define EC_RENDER_SESSION_H

#include "render/render.h"

typedef struct ec_session ec_session;

/* Opens a session. Limits in options are ignored. The wave is fitted to batches of `largest` samples. stats gets what set-up knows (its seconds,
 * lanes, wave, effects) and, in device_bytes, the buffers' peak so far. The scene is not needed afterwards. */
ec_result ec_session_open(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t largest,
                          ec_session **session, ec_render_stats *stats, ec_error *err);
void ec_session_close(ec_session *session); /* NULL is fine */

/* The settings that may change without setting up scene, structures and kernels again. */
typedef struct ec_session_view {
    ec_camera camera;
    uint32_t width, height;          /* pixels */
    double env_degrees;              /* turns the environment's map from where the scene has it; kernels must be built for that:
                                      * EC_FEATURE_ENVIRONMENT_TURN in more_effects */
} ec_session_view;
/* Sets the view of the next batches. The lens is that of the options. */
ec_result ec_session_look(ec_session *session, const ec_session_view *view, ec_error *err);

/* Predicts the rare paths of the picture that the next batches are of; to be called between batches. */
ec_result ec_session_predict(ec_session *session, ec_rare *rare, ec_error *err);

/* Returns how many samples a pixel one batch may have: a pixel's samples are in flight together. */
uint32_t ec_session_largest(const ec_session *session);

typedef struct ec_session_batch {
    uint32_t seed;
    uint32_t replicate;              /* of that seed: another one, other random numbers */
    uint32_t first, samples;         /* a pixel: of the replicate's, from number `first` on */
    bool (*go_on)(void *user);       /* asked between waves; NULL: never stops */
    void *user;
    double slice;                    /* seconds that a wave may take, as far as that is known; 0: any time */
    float *features;                 /* result, if not NULL: of first hits, EC_FILM_FEATURES a pixel */
    float *batch;                    /* result, if not NULL: EC_BATCH_FIELDS a pixel (shared/params.h); values that are not finite become 0, and are
                                      * counted */
    float *rgb;                      /* result, if not NULL: R, G, B alone */
    double seconds;                  /* result */
    uint64_t invalid;                /* result: values that were not finite */
    bool complete;                   /* result: false where go_on said no; the other results are of no use then */
} ec_session_batch;
ec_result ec_session_take(ec_session *session, ec_session_batch *batch, ec_error *err);

/* Returns the samples a second of the last waves of batches with a slice; 0: none yet. */
double ec_session_rate(const ec_session *session);

/* Reads how many samples the kernels have dropped so far because they were not finite. */
ec_result ec_session_invalid(ec_session *session, uint64_t *samples, ec_error *err);

/* Returns a seed for picture `index` of stream `stream`: streams are independent of each other and of those of ec_render. */
uint32_t ec_session_seed(uint64_t seed, uint32_t stream, uint32_t index);

#endif
