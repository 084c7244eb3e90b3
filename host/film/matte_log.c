#include "film/matte_log.h"

#include <stdlib.h>
#include <string.h>

static bool grow(ec_matte_log *log, uint64_t count)
{
    if (log->count + count <= log->room) return true;
    const uint64_t room = 2 * log->room + count;
    ec_matte_entry *entries = realloc(log->entries, room * sizeof *entries);
    if (entries) log->entries = entries, log->room = room;
    return entries != NULL;
}

bool ec_matte_log_add(ec_matte_log *log, const ec_matte_entry *entries, uint64_t count)
{
    if (!count) return true;
    if (log->lock) pthread_mutex_lock(log->lock);
    const bool grown = grow(log, count);
    if (grown) memcpy(log->entries + log->count, entries, count * sizeof *entries), log->count += count;
    if (log->lock) pthread_mutex_unlock(log->lock);
    return grown;
}

bool ec_matte_log_samples(ec_matte_log *log, uint32_t position, const float *nodes, const float *materials, uint32_t count)
{
    const uint64_t first = log->count;
    for (uint32_t s = 0; s < count; s++) {
        const ec_matte_entry met = {position, (uint32_t)nodes[s], (uint32_t)materials[s], 1};
        uint64_t i = first;
        if (!met.material) continue;
        while (i < log->count && (log->entries[i].node != met.node || log->entries[i].material != met.material)) i++;
        if (i < log->count) log->entries[i].samples++;
        else if (!ec_matte_log_add(log, &met, 1)) return false;
    }
    return true;
}
