/* A scripted hand, for measuring and for tests. A line each, # begins a comment:
 *     turn YAW PITCH SECONDS     around the target, degrees; 0 seconds: at once, as all moves
 *     pan RIGHT UP SECONDS       heights of the picture
 *     dolly FACTOR SECONDS       of the distance
 *     wait SECONDS
 *     settle                     until the limit of the render is met
 *     key NAME                   as in the help: e, E, 1, Tab, F5, Save; digits switch effects while their list is open (X)
 *     quit                       also at the end
 * "orbit" stands for a turn of 360 degrees in 6 seconds. */
#ifndef EC_VIEW_SCRIPT_H
#define EC_VIEW_SCRIPT_H

#include "view/input.h"

typedef struct ec_script_step {
    char verb[16], key[16];
    double a, b, seconds;
} ec_script_step;

enum { EC_SCRIPT_STEPS = 256 };
typedef struct ec_script {
    ec_script_step steps[EC_SCRIPT_STEPS];
    uint32_t count, at;
    double done;          /* seconds of the step that is under way */
    bool moves;           /* it is a move of the camera */
} ec_script;

eclat_result ec_script_read(ec_script *script, const char *file_or_orbit, eclat_error *err);

/* The next `seconds` of it. */
void ec_script_run(ec_script *script, ec_view_input *input, const eclat_status *status, double seconds);

#endif
