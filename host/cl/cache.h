/* Compiled kernels on disk. Knows nothing of OpenCL calls: bytes in, bytes out. Inside host/cl and its tests only. */
#ifndef EC_CL_CACHE_H
#define EC_CL_CACHE_H

#include "cl/cl.h"

typedef struct ec_cache_key {
    uint8_t bytes[32];
    char hex[65];
} ec_cache_key;

/* Returns the key: SHA-256 over everything that a binary depends on. */
ec_cache_key ec_cache_key_of(const ec_device_info *device, const char *source, const char *options);

/* Makes a folder like mkdir -p, private as XDG asks. Returns false if it is not there then. */
bool ec_cache_make_folder(const char *folder);

/* Writes the folder's path: `chosen`, else ${XDG_CACHE_HOME:-$HOME/.cache}/eclat/kernels. Returns false if there is none (no HOME). */
bool ec_cache_folder(const char *chosen, char *path, size_t size);

/* Returns false on a miss: no entry, or one that is truncated, altered or another key's. *binary is malloc'ed. */
bool ec_cache_load(const char *folder, const ec_cache_key *key, unsigned char **binary, size_t *bytes);

/* Makes the folder, writes a temporary file in it and renames it, so that readers see all or nothing. Returns false if it could not; nothing is left
 * behind then. */
bool ec_cache_store(const char *folder, const ec_cache_key *key, const unsigned char *binary, size_t bytes);

#endif
