/* In place of the rest of view/ where GLFW, libepoxy, stb_truetype or the font are missing. */
#include "view/view.h"

ec_result ec_view_available(ec_error *err)
{
    return ec_fail(err, "this eclat was built without its preview window: install libglfw3-dev, libepoxy-dev, libstb-dev and "
                        "fonts-dejavu-core, then build again with -DECLAT_PREVIEW=ON; 'eclat render' needs none of them");
}

ec_result ec_view_run(const ec_view_request *request, ec_error *err)
{
    (void)request;
    return ec_view_available(err);
}

void ec_view_print_keys(void) {}
