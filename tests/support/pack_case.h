/* A scene that is made here, packed. */
#ifndef EC_TESTS_SUPPORT_PACK_CASE_H
#define EC_TESTS_SUPPORT_PACK_CASE_H

#include "gltf/reader.h"
#include "pack/pack.h"
#include "support/gltf_writer.h"
#include "support/test.h"

/* Frees w. */
static inline ec_pack pack_of(gltf_writer *w, const char *name)
{
    ec_scene *scene;
    ec_pack pack = {0};
    ec_error err = {0};
    CHECK_OK(ec_scene_load(gltf_write(w, name), &scene, NULL, &err), err);
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    ec_scene_free(scene);
    free(w);
    return pack;
}

#endif
