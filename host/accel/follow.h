/* Structures from one moment to the next: what has not moved is kept; what has moved is refitted or built again, whichever is cheaper by the times
 * measured so far. The hits are the same in any case. */
#ifndef EC_ACCEL_FOLLOW_H
#define EC_ACCEL_FOLLOW_H

#include "accel/accel.h"
#include "accel/shape_trees.h"

typedef enum ec_follow { EC_FOLLOW_BUILT, EC_FOLLOW_KEPT, EC_FOLLOW_REFITTED, EC_FOLLOW_REBUILT } ec_follow;
extern const char *const ec_follow_names[]; /* in the order of ec_follow */

typedef struct ec_follow_report {
    ec_follow what;
    double seconds;          /* seconds that this took in all */
    double refit_seconds;    /* of them: trying a refit; 0: none was tried */
    double build_seconds;    /* of the last build */
    double expense;          /* expense of the trees as they are, over that after their last build */
    double refit_expense;    /* what a refit has come to, even if it was given up; 0: none was tried */
    uint32_t meshes_kept, meshes_built; /* trees of meshes that are kept once */
} ec_follow_report;

/* Zero-initialised: no structures yet. */
typedef struct ec_followed {
    ec_accel accels[EC_ACCEL_COUNT]; /* the current structures; their buffers are owned */
    uint32_t present;                /* 1 << which */
    double built_expense[EC_ACCEL_COUNT];
    struct ec_followed_input *input; /* a copy of what they were last made of */
    ec_shape_trees trees;
    double trace_seconds;            /* what rays took in the moment before; 0: not known */
    double refit_seconds;            /* of the last refit; 0: there was none */
    ec_follow_report report;         /* of the last call */
} ec_followed;

/* Updates the structures `wanted` (1 << which) to the input's triangles. After a failure there are none. */
ec_result ec_accels_follow(ec_followed *followed, ec_accel_input *input, uint32_t wanted, ec_error *err);
/* Reports how long tracing took with these structures: a refit that would lengthen it by more than a build takes is given up. */
void ec_followed_tell(ec_followed *followed, double trace_seconds);
void ec_followed_free(ec_followed *followed);

#endif
