#include "cl/notes.h"

#include <stdlib.h>
#include <string.h>

#include "cl/cache.h"

bool ec_notes_read(const ec_cl *cl, const char *name, void *bytes, size_t size)
{
    const ec_cache_key key = ec_cache_key_of(&cl->info, name, "note");
    char folder[4096];
    unsigned char *found = NULL;
    size_t found_size = 0;
    const bool is_there = ec_cache_folder(cl->cache_dir, folder, sizeof folder) && ec_cache_load(folder, &key, &found, &found_size);
    const bool is_whole = is_there && found_size == size;
    if (is_whole) memcpy(bytes, found, size);
    free(found);
    return is_whole;
}

void ec_notes_write(const ec_cl *cl, const char *name, const void *bytes, size_t size)
{
    const ec_cache_key key = ec_cache_key_of(&cl->info, name, "note");
    char folder[4096];
    if (ec_cache_folder(cl->cache_dir, folder, sizeof folder)) ec_cache_store(folder, &key, bytes, size);
}
