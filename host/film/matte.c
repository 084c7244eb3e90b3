#include "film/matte.h"

#include <stdlib.h>
#include <string.h>

ec_result ec_matte_create(ec_matte *matte, uint64_t pixels, ec_error *err)
{
    *matte = (ec_matte){.first = calloc(pixels, sizeof *matte->first)};
    return matte->first ? EC_OK : ec_fail(err, "out of memory for cryptomatte of %llu pixels", (unsigned long long)pixels);
}

void ec_matte_free(ec_matte *matte)
{
    free(matte->first);
    free(matte->seen);
    *matte = (ec_matte){0};
}

static bool make_room(ec_matte *matte, uint64_t more)
{
    if (matte->count + more <= matte->room) return true;
    const uint64_t room = matte->room + matte->room / 2 + more;
    ec_matte_seen *seen = room < UINT32_MAX ? realloc(matte->seen, room * sizeof *seen) : NULL;
    if (seen) matte->seen = seen, matte->room = room;
    return seen != NULL;
}

ec_result ec_matte_take(ec_matte *matte, const ec_matte_log *log, const uint32_t *places, ec_error *err)
{
    if (!make_room(matte, log->count)) return ec_fail(err, "out of memory for cryptomatte; leave it out, or give a smaller --size");
    for (uint64_t i = 0; i < log->count; i++) {
        const ec_matte_entry *e = &log->entries[i];
        uint32_t *first = &matte->first[places ? places[e->position] : e->position], at = *first;
        while (at && (matte->seen[at - 1].node != e->node || matte->seen[at - 1].material != e->material)) at = matte->seen[at - 1].next;
        if (at) {
            matte->seen[at - 1].samples += e->samples;
            continue;
        }
        matte->seen[matte->count++] = (ec_matte_seen){*first, e->node, e->material, e->samples};
        *first = (uint32_t)matte->count;
    }
    return EC_OK;
}

typedef struct finder {
    const ec_matte *matte;
    const uint32_t *hashes;
    bool by_material;
    uint32_t first;
} finder;

static uint32_t hash_of(const finder *f, uint32_t at)
{
    const ec_matte_seen *seen = &f->matte->seen[at - 1];
    return f->hashes[f->by_material ? seen->material : seen->node];
}

static uint32_t samples_of(const finder *f, uint32_t hash)
{
    uint32_t samples = 0;
    for (uint32_t at = f->first; at; at = f->matte->seen[at - 1].next)
        if (hash_of(f, at) == hash) samples += f->matte->seen[at - 1].samples;
    return samples;
}

/* Goes on to the next hash, by falling number of samples and then by hash; returns false if there is none. */
static bool next_after(const finder *f, uint32_t *hash, uint32_t *samples)
{
    const uint32_t before = *hash, most = *samples;
    uint32_t best = 0, best_hash = 0;
    for (uint32_t at = f->first; at; at = f->matte->seen[at - 1].next) {
        const uint32_t own = hash_of(f, at), count = samples_of(f, own);
        if (count > most || (count == most && own <= before)) continue;
        if (count > best || (count == best && own < best_hash)) best = count, best_hash = own;
    }
    *hash = best_hash, *samples = best;
    return best > 0;
}

void ec_matte_pixel(const ec_matte *matte, const ec_layers *layers, enum ec_matte_kind kind, uint64_t pixel, double samples, float *out)
{
    const finder f = {matte, layers->matte_hashes[kind], kind == EC_MATTE_MATERIAL, matte->first[pixel]};
    uint32_t hash = 0, count = UINT32_MAX;
    memset(out, 0, EC_MATTE_FLOATS * sizeof *out);
    for (uint32_t k = 0; k < EC_MATTE_RANKS && next_after(&f, &hash, &count); k++) {
        memcpy(out + 2 * k, &hash, sizeof hash);
        out[2 * k + 1] = (float)(count / samples);
    }
}
