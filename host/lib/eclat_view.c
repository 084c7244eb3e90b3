#include "lib/internal.h"
#include "view/view.h"

eclat_note eclat_view_key_at(size_t i)
{
    const ec_view_module *window;
    eclat_note key = {.heading = "Keys and mouse"};
    return ec_view_load(&window, NULL) == EC_OK && window->key_at(i, &key.term, &key.text) ? key : (eclat_note){0};
}
