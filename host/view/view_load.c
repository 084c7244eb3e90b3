#include "base/module.h"
#include "view/view.h"

ec_result ec_view_load(const ec_view_module **module, ec_error *err)
{
    const void *symbol = NULL;
    EC_TRY(ec_module_load("view", "this eclat was built without its preview window: install libglfw3-dev, libepoxy-dev, libstb-dev and "
                                  "fonts-dejavu-core, then build again with -DECLAT_PREVIEW=ON; 'eclat render' needs none of them", &symbol, err));
    *module = symbol;
    return EC_OK;
}
