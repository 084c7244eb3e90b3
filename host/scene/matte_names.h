/* The names that Cryptomatte knows things by: of a node or else of its mesh, of a material, and of the node that all of it hangs below. */
#ifndef EC_SCENE_MATTE_NAMES_H
#define EC_SCENE_MATTE_NAMES_H

#include "base/matte_kinds.h"
#include "scene/scene.h"

enum { EC_MATTE_FIELDS = 4, EC_MATTE_FIELD = 32 };

/* Kinds that are asked for have names; others are NULL. All owned. */
typedef struct ec_matte_names {
    uint32_t *hashes[EC_MATTE_KINDS];  /* by number plus 1 of a node, of a material; 0 is what is of no node */
    char *manifests[EC_MATTE_KINDS];   /* which name has which hash, JSON */
    char keys[EC_MATTE_KINDS][EC_MATTE_FIELDS][EC_MATTE_FIELD]; /* names of what a file says of it: name, hash, conversion, manifest */
} ec_matte_names;

extern const char *const ec_matte_kind_names[EC_MATTE_KINDS]; /* as of channels: CryptoObject */

/* kinds: a bit for each ec_matte_kind. */
ec_result ec_matte_names_find(const ec_scene *scene, uint32_t kinds, ec_matte_names *names, ec_error *err);
void ec_matte_names_free(ec_matte_names *names); /* zero-initialised ones are fine */

#endif
