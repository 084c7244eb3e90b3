#include "base/module.h"
#include "view/view.h"

EC_MODULE_EXPORT extern const ec_view_module EC_MODULE_SYMBOL;
const ec_view_module EC_MODULE_SYMBOL = {ec_view_run, ec_view_key_at};
