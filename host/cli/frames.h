/* eclat render --frames: one picture after the other. */
#ifndef EC_CLI_FRAMES_H
#define EC_CLI_FRAMES_H

#include "cli/console.h"
#include "cli/render_request.h"
#include "ranks/ranks.h"

/* argv: `render` and its arguments, as they were given; start: when the command began. All that can be wrong with the sequence is said
 * before its first sample. A frame that fails leaves the others; the result is EC_FAILED then, and where Ctrl-C ended it. */
ec_result ec_frames_render(ec_console *console, const ec_render_request *request, ec_ranks *ranks, int argc,
                           char *const *argv, double start, ec_error *err);

#endif
