#include "scene/texels.h"

#include <stdlib.h>

#include "base/memory.h"

ec_texels *ec_texels_make(uint64_t count)
{
    ec_texels *made = malloc(sizeof *made);
    uint32_t *words = made ? ec_shared_alloc((count + 1) * sizeof *words) : NULL;
    if (!words) {
        free(made);
        return NULL;
    }
    *made = (ec_texels){.count = count, .words = words};
    atomic_init(&made->users, 1);
    words[count] = 0;
    return made;
}

ec_texels *ec_texels_keep(ec_texels *texels)
{
    atomic_fetch_add(&texels->users, 1);
    return texels;
}

void ec_texels_leave(ec_texels *texels)
{
    if (!texels || atomic_fetch_sub(&texels->users, 1) > 1) return;
    free(texels->words);
    free(texels);
}
