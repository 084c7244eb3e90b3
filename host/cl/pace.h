/* Limits how many work-items a launch may have. The driver of a card that also draws a screen takes a launch of seconds for a hang, and ends it or
 * the program. Launches are therefore cut into pieces, whose times say how large the next ones may be. */
#ifndef EC_CL_PACE_H
#define EC_CL_PACE_H

#include "cl/cl.h"

/* Sets the limit: ECLAT_LAUNCH_SECONDS, else half a second on cards and none on processors. */
ec_result ec_pace_begin(ec_cl *cl, ec_error *err);

/* Returns the pace of the kernel with this label; NULL: its launches need not be cut. */
ec_pace *ec_pace_of(ec_cl *cl, const char *label);
/* Returns the work-items of the next piece, of those that are left of a launch; both are multiples of `group`. */
uint64_t ec_pace_piece(const ec_pace *pace, uint64_t left, uint64_t group);
/* Notes that a piece took so long, by the device's clock. */
void ec_pace_took(ec_cl *cl, ec_pace *pace, double seconds);
/* Fits the sizes of pieces, once all that were launched are done. */
void ec_pace_learn(ec_cl *cl);

#endif
