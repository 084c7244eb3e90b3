/* Renders strip by strip: strips.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "film/layer_films.h"
#include "render/render_state.h"
#include "render/strips.h"

/* Returns the memory that drivers take when kernels first run. PoCL compiles their last part then: 13 MB for the Cornell box, 127 for all effects;
 * where it has done so before (the cache was hit), none was seen. */
static uint64_t driver_bytes(const ec_cl *cl) { return cl->cache_misses ? 144ull << 20 : 8ull << 20; }

ec_result ec_render_choose_rows(ec_render_state *r, const ec_log *log, ec_error *err)
{
    const ec_render_options *o = r->options;
    const ec_pipeline *p = ec_sources_alone(&r->sources);
    const ec_device_info *device = &p->cl->info;
    const bool shared = device->type & CL_DEVICE_TYPE_CPU, can = r->course->strip != NULL;
    const uint64_t whole = ec_strip_whole(o), left = device->memory_bytes - p->cl->allocated_bytes;
    if (!o->memory && (whole < EC_STRIP_NEVER || !can)) return EC_OK;
    const int64_t budget = ec_strip_budget(o, driver_bytes(p->cl) + (shared ? p->wave_bytes : 0));
    const uint32_t rows = ec_strip_rows(o, shared, budget, left, device->max_allocation_bytes);
    r->stats->strips = rows ? (o->height + rows - 1) / rows : 1;
    if (rows == o->height || (!rows && !o->memory)) return EC_OK;
    if (!rows)
        return ec_fail(err, "--memory: %.0f MB are not enough for scene, program and %u rows of this picture, %.1f MB; give %.0fM or more, "
                            "or a narrower picture", (double)o->memory / 1e6, EC_STRIP_STEP, (double)ec_strip_least(o) / 1e6,
                       ceil((double)((int64_t)(o->memory + ec_strip_least(o)) - budget) / 1e6));
    if (!can) return ec_strip_refuse(o, whole, budget, r->course->whole_for, "leave it out", err);
    r->strip_rows = rows;
    ec_note(log, "not all %u rows fit into %s memory at once; the picture is rendered in %u strips of %u rows", o->height, o->memory ? "that" : "free",
            r->stats->strips, rows);
    return EC_OK;
}

/* Renders a strip. One that is not complete is of no use to a picture. */
static ec_result render_strip(ec_render_state *r, uint32_t first_row, uint32_t rows, const ec_log *log, ec_error *err)
{
    ec_render_stats told = *r->stats;
    r->past = (ec_past){.seconds = first_row ? ec_now() - r->render_start : 0.0, .allotment.gain = 1.0};
    r->stopped_by = NULL;
    EC_TRY(ec_film_create(r->film, r->options->width, rows, r->replicates, err));
    ec_film_want_features(r->film, ec_render_feature_sets(r->options), ec_render_feature_end(r->options));
    EC_TRY(ec_film_set_layers(r->film, &r->options->layers, err));
    EC_TRY(ec_film_set_rare(r->film, &r->rare, err));
    EC_TRY(r->source->turn_to(r->source, first_row, rows, err));
    EC_TRY(ec_render_find_limit(r, rows, log, err));
    EC_TRY(ec_render_film(r, log, err));
    if (strcmp(r->stopped_by, "spp")) return EC_OK;
    r->samples_before += r->past.samples;
    r->invalid_in_films += r->film->invalid_count;
    told.samples = r->samples_before;
    return r->course->strip(r->course->user, r->film, first_row, &told, err);
}

ec_result ec_render_strips(ec_render_state *r, const ec_log *log, ec_error *err)
{
    const uint32_t height = r->options->height;
    ec_result result = EC_OK;
    r->stopped_by = "spp";
    for (uint32_t row = 0, rows; result == EC_OK && row < height && !strcmp(r->stopped_by, "spp"); row += rows) {
        rows = height - row < r->strip_rows ? height - row : r->strip_rows;
        result = render_strip(r, row, rows, log, err);
        ec_film_destroy(r->film);
    }
    r->past.samples = r->samples_before;
    r->error.error = r->error.error_bound = r->error.relmse = INFINITY; /* those of strips are not the picture's */
    return result;
}
