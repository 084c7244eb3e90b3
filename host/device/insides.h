/* The media that a camera is inside of, wherever it goes: the closed bodies of a scene by which light is refracted or absorbed. */
#ifndef EC_DEVICE_INSIDES_H
#define EC_DEVICE_INSIDES_H

#include "pack/pack.h"

typedef struct ec_insides {
    ec_scene bodies;     /* their triangles alone, under numbers of their own for materials; owned */
    uint32_t *medium;    /* medium of each such material, as paths keep it. Owned */
    bool nested;         /* media are sets */
} ec_insides;

/* Makes them; pack is not needed afterwards. */
ec_result ec_insides_make(const ec_pack *pack, uint64_t called, ec_insides *insides, ec_error *err);
void ec_insides_free(ec_insides *insides); /* zero-initialised is fine */

/* Returns the camera's medium, as paths keep it. An orthographic camera is all over its plane: outside. */
uint32_t ec_insides_of(const ec_insides *insides, const ec_camera *camera);

#endif
