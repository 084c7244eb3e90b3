/* Which options make sense together. */
#ifndef EC_CLI_COMBINATIONS_H
#define EC_CLI_COMBINATIONS_H

#include "cli/options.h"
#include "pipeline/render.h"

/* given[i]: options[i] was on the command line. EC_USAGE, and one line that says what belongs together, where it does not. */
ec_result ec_combinations_check(const ec_option *options, int count, const bool *given, const ec_render_options *asked,
                                ec_error *err);

#endif
