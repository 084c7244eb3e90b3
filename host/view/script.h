/* Scripted input, for measuring and for tests. One step per line; # begins a comment:
 *     turn YAW PITCH SECONDS     degrees around the target; 0 seconds: at once, as for all moves
 *     pan RIGHT UP SECONDS       in heights of the picture
 *     dolly FACTOR SECONDS       multiplies the distance
 *     wait SECONDS
 *     settle                     waits until a limit of the render is met
 *     key NAME                   as in the help: e, E, 1, Tab, F5, Save; digits switch effects while their list is open (X)
 *     quit                       closes the window, as does the end of the script
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
    double done;          /* seconds of the current step */
    bool moves;           /* the current step moves the camera */
} ec_script;

eclat_result ec_script_read(ec_script *script, const char *file_or_orbit, eclat_error *err);

/* Runs the next `seconds` of it. */
void ec_script_run(ec_script *script, ec_view_input *input, const eclat_status *status, double seconds);

#endif
