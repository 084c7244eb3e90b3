#include "render/sources.h"

#include <stdlib.h>

#include "film/threads.h"

ec_result ec_sources_enlist(ec_cl *devices, uint32_t count, uint32_t lanes, ec_sources *s, ec_render_stats *stats, ec_error *err)
{
    s->devices = devices;
    s->count = s->unloaded = count;
    for (uint32_t i = 0; i < count; i++) EC_TRY(ec_pipeline_lanes(&devices[i], lanes, &stats->lanes, err)); /* checked before the work that follows */
    bool cards_alone = count > 0;
    for (uint32_t i = 0; i < count; i++) cards_alone &= !(devices[i].info.type & CL_DEVICE_TYPE_CPU);
    ec_film_beside_cards(cards_alone);
    s->candidates = calloc(count + 1u, sizeof *s->candidates); /* there may be no devices, but peers */
    return s->candidates ? EC_OK : ec_fail(err, "out of memory for %u devices", count);
}

ec_result ec_sources_pack(ec_cl *devices, uint32_t count, bool for_all, const ec_scene *scene,
                          const ec_render_options *options, uint32_t batch, ec_sources *s, ec_render_stats *stats,
                          ec_error *err)
{
    uint32_t kinds = for_all ? (1u << EC_KIND_COUNT) - 1 : 0;
    EC_TRY(ec_sources_enlist(devices, count, options->lanes, s, stats, err));
    for (uint32_t i = 0; i < count; i++) kinds |= 1u << ec_device_kind_of(&devices[i].info);
    return ec_payload_make(scene, options, batch, kinds, count == 1 && !for_all ? devices : NULL, &s->payload, stats, err);
}

/* Loads a device, in the member's thread. */
static ec_result load(void *user, ec_batch_source **source, ec_error *err)
{
    ec_source_candidate *r = user;
    ec_sources *s = r->all;
    *source = &r->source.base;
    ec_result result = ec_device_source_open(r->cl, &s->payload, NULL, s->seed, &r->source, &r->stats, err);
    pthread_mutex_lock(&s->lock);
    if (--s->unloaded == 0) ec_payload_free(&s->payload);
    pthread_mutex_unlock(&s->lock);
    if (result == EC_OK) result = r->source.base.turn_to(*source, 0, r->source.pipeline.params.height, err);
    r->stats.wave = r->source.pipeline.room;
    return result;
}

static ec_result open_team(ec_sources *s, const ec_peers *peers, const ec_log *log, ec_error *err)
{
    ec_team_candidate *candidates = calloc(s->count + peers->count, sizeof *candidates);
    if (!candidates) return ec_fail(err, "out of memory for a team of %u", s->count + peers->count);
    pthread_mutex_init(&s->lock, NULL);
    for (uint32_t i = 0; i < s->count; i++) {
        s->candidates[i] = (ec_source_candidate){.all = s, .cl = &s->devices[i]};
        candidates[i] = (ec_team_candidate){.name = s->devices[i].info.name, .open = load, .user = &s->candidates[i]};
    }
    for (uint32_t i = 0; i < peers->count; i++)
        if (peers->candidate(peers->user, i, &candidates[s->count + s->peer_members]))
            s->peer_processes += candidates[s->count + s->peer_members++].processes;
    ec_result result = ec_team_open(candidates, s->count + s->peer_members, s->payload.head.params.width,
                                    s->payload.head.params.height, s->payload.head.replicates, log, &s->team, err);
    free(candidates);
    if (result == EC_OK) ec_team_wait(s->team, s->count); /* limits of time do not include compiling */
    return result;
}

static uint64_t received(const ec_sources *s) { return s->peers.received ? s->peers.received(s->peers.user) : 0; }

ec_result ec_sources_open(ec_sources *s, uint64_t seed, const ec_peers *peers, const ec_log *log,
                          ec_batch_source **source, ec_render_stats *stats, ec_error *err)
{
    const ec_peers none = {0};
    s->seed = seed;
    s->peers = peers ? *peers : none;
    s->received_before = received(s);
    if (peers) EC_TRY(peers->send(peers->user, &s->payload, seed, log, err));
    if (s->count > 1 || peers) {
        EC_TRY(open_team(s, peers ? peers : &none, log, err));
        *source = ec_team_source(s->team);
        return EC_OK;
    }
    *source = &s->candidates->source.base;
    s->devices->log = log;
    return ec_device_source_open(s->devices, &s->payload, &s->payload, seed, &s->candidates->source, stats, err);
}

const ec_pipeline *ec_sources_alone(const ec_sources *s) { return s->team ? NULL : &s->candidates->source.pipeline; }

ec_pipeline *ec_sources_pipeline(ec_sources *s, uint32_t device, bool waits)
{
    return !s->team || ec_team_is_ready(s->team, device, waits) ? &s->candidates[device].source.pipeline : NULL;
}

static void tell_shares(const ec_sources *s, ec_render_stats *stats)
{
    const double pixels = (double)s->payload.head.params.width * s->payload.head.params.height;
    bool has_failed;
    stats->share_count = s->count;
    stats->peers = s->peer_processes;
    stats->peer_bytes = received(s) - s->received_before;
    for (uint32_t i = 0; i < s->peer_members; i++)
        stats->peer_samples += ec_team_share(s->team, s->count + i, &has_failed) / pixels;
    for (uint32_t i = 0; i < s->count; i++) {
        const ec_render_stats *own = &s->candidates[i].stats;
        ec_render_share *share = &stats->shares[i];
        share->samples = ec_team_share(s->team, i, &share->has_failed) / pixels;
        share->lanes = own->lanes;
        share->wave = own->wave;
        share->device_bytes = s->devices[i].peak_allocated_bytes;
        stats->programs_found += own->programs_found;
        stats->programs_built += own->programs_built;
        stats->bytes_found += own->bytes_found;
        stats->bytes_uploaded += own->bytes_uploaded;
        if (!stats->wave) stats->wave = own->wave, stats->lanes = own->lanes;
        if (own->kernel_seconds > stats->kernel_seconds) stats->kernel_seconds = own->kernel_seconds;
    }
}

void ec_sources_close(ec_sources *s, ec_render_stats *stats)
{
    if (s->team) {
        ec_batch_source *team = ec_team_source(s->team);
        team->close(team);
        tell_shares(s, stats);
        ec_team_free(s->team);
        pthread_mutex_destroy(&s->lock);
    } else if (s->candidates && s->candidates->source.base.close) {
        s->candidates->source.base.close(&s->candidates->source.base);
        s->devices->log = NULL;
    }
    for (uint32_t i = 0; i < s->count; i++) {
        stats->device_bytes += s->devices[i].peak_allocated_bytes;
        stats->cache_hits += s->devices[i].cache_hits;
        stats->cache_misses += s->devices[i].cache_misses;
        stats->launches += s->devices[i].paces.launches;
        stats->pieces += s->devices[i].paces.pieces;
        if (s->devices[i].paces.longest > stats->longest_piece) stats->longest_piece = s->devices[i].paces.longest;
    }
    ec_payload_free(&s->payload);
    free(s->candidates);
}
