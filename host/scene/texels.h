/* Texels of pictures in one piece, as kernels read them. Pictures and the device have them in common: the last one to leave frees them. Threads may
 * keep and leave at once. */
#ifndef EC_SCENE_TEXELS_H
#define EC_SCENE_TEXELS_H

#include <stdatomic.h>
#include <stdint.h>

typedef struct ec_texels {
    atomic_uint users;
    uint64_t count;
    uint32_t *words; /* one a texel, R lowest; and a zero behind the last, as some are read two at a time. As ec_shared_alloc gives them */
} ec_texels;

ec_texels *ec_texels_make(uint64_t count); /* for one user, of any values; NULL: there is no memory */
ec_texels *ec_texels_keep(ec_texels *texels); /* for one more */
void ec_texels_leave(ec_texels *texels); /* NULL is fine */

#endif
