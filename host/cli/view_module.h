#ifndef EC_CLI_VIEW_MODULE_H
#define EC_CLI_VIEW_MODULE_H

#include "base/error.h"
#include "view/view.h"

/* The window; fails where the program was built without it. */
ec_result ec_view_load(const ec_view_module **module, ec_error *err);

#endif
