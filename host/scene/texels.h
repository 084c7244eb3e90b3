/* Texels of pictures in one block, as kernels read them. Pictures and the device share them; the last user frees them. ec_texels_keep and _leave are
 * thread-safe. */
#ifndef EC_SCENE_TEXELS_H
#define EC_SCENE_TEXELS_H

#include <stdatomic.h>
#include <stdint.h>

typedef struct ec_texels {
    atomic_uint users;
    uint64_t count;
    uint32_t *words; /* one per texel, R lowest, and a zero behind the last, as some are read two at a time. From ec_shared_alloc */
} ec_texels;

ec_texels *ec_texels_make(uint64_t count); /* for one user, uninitialised; NULL: out of memory */
ec_texels *ec_texels_keep(ec_texels *texels); /* adds a user */
void ec_texels_leave(ec_texels *texels); /* NULL is fine */

#endif
