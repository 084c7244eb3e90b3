/* Names under which Cryptomatte knows things: of a node (or else its mesh), of a material, and of the root above a node. */
#ifndef EC_SCENE_MATTE_NAMES_H
#define EC_SCENE_MATTE_NAMES_H

#include "base/matte_kinds.h"
#include "scene/scene.h"

enum { EC_MATTE_FIELDS = 4, EC_MATTE_FIELD = 32 };

/* Kinds that are not asked for have NULLs. All owned. */
typedef struct ec_matte_names {
    uint32_t *hashes[EC_MATTE_KINDS];  /* by index plus 1 of a node or material; entry 0 is for what has no node */
    char *manifests[EC_MATTE_KINDS];   /* JSON: names and their hashes */
    char keys[EC_MATTE_KINDS][EC_MATTE_FIELDS][EC_MATTE_FIELD]; /* names of attributes in a file: name, hash, conversion, manifest */
} ec_matte_names;

extern const char *const ec_matte_kind_names[EC_MATTE_KINDS]; /* as in channels: CryptoObject */

/* kinds: bits by ec_matte_kind. */
ec_result ec_matte_names_find(const ec_scene *scene, uint32_t kinds, ec_matte_names *names, ec_error *err);
void ec_matte_names_free(ec_matte_names *names); /* zero-initialised ones are fine */

#endif
