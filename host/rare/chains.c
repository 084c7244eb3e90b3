#include "rare/chains.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "device/guide.h"
#include "film/film.h"
#include "device/adaptive.h"
#include "rare/look.h"

enum { LANES_MOST = 64 }; /* more than any work-item has */
enum { WIDE = 1, WIDE_AT_FIRST = 2 };
#define CHAINS_EACH 8 /* chains of a path, in the mean, at most */

/* The paths of a wave. */
typedef struct tracer {
    ec_look look;
    ec_pipeline *p;
    const ec_rare_lights *lights;
    ec_chains *found;
    uint32_t room;                /* for so many chains */
    uint32_t *at;                 /* by slot: the path's entry in the queue, or UINT32_MAX */
    int64_t *last;                /* by slot: its chain that waits to know where it ended, or -1 */
    uint8_t *wide;                /* by slot: WIDE if it has left a surface in a direction that is not sharp, and WIDE_AT_FIRST if the first one so */
    ec_joined joined;             /* what the paths gather */
    float *queue, *hits;          /* fields of the device's */
} tracer;

static float word(const tracer *t, const float *queue, int field, uint32_t entry) { return queue[(size_t)field * t->look.stride + entry]; }

static uint32_t word_u(const tracer *t, const float *queue, int field, uint32_t entry)
{
    uint32_t value;
    memcpy(&value, &queue[(size_t)field * t->look.stride + entry], sizeof value);
    return value;
}

/* Finds where each path is in the queue, whose order depends on threads. */
static void find_paths(tracer *t, const uint32_t *parts)
{
    memset(t->at, 0xff, t->look.count * sizeof *t->at);
    for (uint32_t k = 0; k < EC_PARTS; k++)
        for (uint32_t i = 0; i < parts[k * EC_PART_STRIDE]; i++) {
            const uint32_t entry = k * t->p->params.part + i, slot = word_u(t, t->queue, EC_PATH_SLOT, entry);
            if (slot < t->look.count) t->at[slot] = entry;
        }
}

static bool is_chain(const ec_params *params, float pdf)
{
    if (params->sample == EC_SAMPLE_BSDF || params->sample == EC_SAMPLE_HEMISPHERE) return true;
    return pdf < 0 || pdf > EC_CHAIN_SHARP;
}

static float beta_of(const tracer *t, uint32_t entry)
{
    return (float)ec_luminance((double[3]){word(t, t->queue, EC_PATH_BR, entry), word(t, t->queue, EC_PATH_BG, entry), word(t, t->queue, EC_PATH_BB, entry)});
}

static void set_segment(const tracer *t, uint32_t slot, uint32_t entry, uint32_t segment, ec_chain *c)
{
    for (int k = 0; k < 3; k++) {
        c->origin[k] = word(t, t->queue, EC_PATH_OX + k, entry);
        c->direction[k] = word(t, t->queue, EC_PATH_DX + k, entry);
    }
    c->beta = beta_of(t, entry);
    c->prim = word_u(t, t->queue, EC_PATH_PRIM, entry);
    c->hit = word_u(t, t->hits, EC_HIT_PRIM, entry);
    c->reach = c->hit == EC_NO_ID ? INFINITY : NAN;
    c->place = ec_pixel_place(&t->p->params, t->look.list[EC_LIST_WORDS * (t->look.first + slot)]);
    c->segment = segment;
}

/* Returns the density with which the surface alone samples the path's direction, without the guide: what a guide makes narrow, light sampling copes
 * with. */
static float pdf_of(const tracer *t, uint32_t entry)
{
    const float pdf = word(t, t->queue, EC_PATH_PDF, entry);
    float p[3], d[3];
    double share;
    for (int k = 0; k < 3; k++) {
        p[k] = word(t, t->queue, EC_PATH_OX + k, entry);
        d[k] = word(t, t->queue, EC_PATH_DX + k, entry);
    }
    const double guided = ec_guide_pdf(t->p->guide, p, d, &share);
    return pdf > 0 ? (float)fmax((pdf - share * guided) / (1 - share), FLT_MIN) : pdf;
}

static bool casts(const tracer *t, uint32_t prim) { return prim != EC_NO_ID && t->lights->casts[ec_rare_material_of(t->lights, prim)]; }

static void note_chain(tracer *t, uint32_t slot, uint32_t entry, uint32_t segment)
{
    const float pdf = pdf_of(t, entry);
    const bool is_direct = !t->wide[slot] && (pdf < 0 || pdf > EC_CHAIN_SHARP);
    if (!is_direct) t->wide[slot] |= segment == 1 ? WIDE | WIDE_AT_FIRST : WIDE;
    if (t->found->count == t->room || !is_chain(&t->p->params, pdf)) return;
    ec_chain *c = &t->found->chains[t->last[slot] = t->found->count++];
    set_segment(t, slot, entry, segment, c);
    c->pdf = pdf > EC_CHAIN_SHARP ? pdf : INFINITY;
    c->is_direct = is_direct;
    c->is_caustic = (t->wide[slot] & WIDE_AT_FIRST) && segment > 1 && casts(t, c->prim);
}

/* Notes what light paths could bring to a path: they come from casters to where it first meets a surface, if that is not sharp, and are joined to it
 * there. */
static void note_joined(tracer *t, uint32_t slot, uint32_t entry, uint32_t segment)
{
    ec_joined_path *path = &t->joined.paths[t->look.first + slot];
    const bool is_joined = segment && (t->wide[slot] & WIDE_AT_FIRST);
    if (segment == 1) {
        const float p[3] = {word(t, t->queue, EC_PATH_OX, entry), word(t, t->queue, EC_PATH_OY, entry), word(t, t->queue, EC_PATH_OZ, entry)};
        ec_joined_first(path, &t->p->params, p, beta_of(t, entry));
    }
    path->by_segment = is_joined && segment > 1 && casts(t, word_u(t, t->queue, EC_PATH_PRIM, entry));
    path->by_vertex = is_joined && casts(t, word_u(t, t->hits, EC_HIT_PRIM, entry));
}

/* Records a vertex where light is sampled; where a surface has one direction, none is. */
static void note_vertex(tracer *t, uint32_t slot, uint32_t entry, uint32_t segment)
{
    if (segment && word(t, t->queue, EC_PATH_PDF, entry) > 0) set_segment(t, slot, entry, segment, &t->found->vertices[t->found->vertex_count++]);
}

/* Sets the reach of a chain, whose segment ends where the path goes on. */
static void end_chain(tracer *t, uint32_t slot, uint32_t entry)
{
    double squares = 0;
    if (t->last[slot] < 0) return;
    ec_chain *c = &t->found->chains[t->last[slot]];
    for (int k = 0; k < 3; k++) {
        const double way = (double)word(t, t->queue, EC_PATH_OX + k, entry) - c->origin[k];
        squares += way * way;
    }
    c->reach = (float)sqrt(squares);
    t->last[slot] = -1;
}

static void look(tracer *t, uint32_t segment)
{
    for (uint32_t slot = 0; slot < t->look.count; slot++) {
        const uint32_t entry = t->at[slot];
        if (entry != UINT32_MAX) end_chain(t, slot, entry);
        t->last[slot] = -1;
        if (entry == UINT32_MAX) continue;
        if (t->found->vertices && segment < EC_CHAIN_VERTICES) note_vertex(t, slot, entry, segment);
        note_chain(t, slot, entry, segment);
        if (t->joined.paths) note_joined(t, slot, entry, segment);
        const uint32_t hit = word_u(t, t->hits, EC_HIT_PRIM, entry);
        if (hit != EC_NO_ID) t->found->visits[ec_rare_material_of(t->lights, hit)]++;
        else t->found->misses += segment > 0;
    }
}

static ec_result read_fields(const tracer *t, cl_mem from, uint32_t fields, float *into, ec_error *err)
{
    return ec_buffer_read_rows(t->p->cl, from, 4ull * t->p->wave, 4ull * t->look.stride, fields, into, err);
}

static ec_result met(void *user, uint32_t number, ec_error *err)
{
    tracer *t = user;
    ec_pipeline *p = t->p;
    if (number == 0) {
        memset(t->last, 0xff, t->look.count * sizeof *t->last);
        memset(t->wide, 0, t->look.count);
    }
    EC_TRY(read_fields(t, p->buffers[EC_ARG_PATHS], EC_PATH_FIELDS, t->queue, err));
    EC_TRY(read_fields(t, p->buffers[EC_ARG_HITS], EC_HIT_PRIM + 1, t->hits, err));
    find_paths(t, p->counters.at[0].rays);
    look(t, number);
    return EC_OK;
}

static ec_result shaded(void *user, uint32_t number, ec_error *err)
{
    tracer *t = user;
    return ec_joined_gather(&t->joined, &t->look, number, true, err);
}

static ec_result lit(void *user, uint32_t number, ec_error *err)
{
    tracer *t = user;
    return ec_joined_gather(&t->joined, &t->look, number, false, err);
}

/* Returns how many bounces to trace. Where nothing is more than diffuse only the camera's own directions are sharp; one bounce more tells whether paths
 * leave the scene. */
static uint32_t bounces_of(const ec_pipeline *p, bool has_sky, bool has_vertices)
{
    const bool all = (p->effects.called.bits & EC_FEATURE_SPECULAR) || p->params.sample == EC_SAMPLE_BSDF || p->params.sample == EC_SAMPLE_HEMISPHERE;
    const uint32_t most = all ? EC_CHAIN_BOUNCES : has_vertices ? EC_CHAIN_VERTICES : has_sky ? 2 : 1;
    return most < p->params.max_depth ? most : p->params.max_depth;
}

/* Traces up to `most` paths; there is room for `each` chains a path. */
static ec_result trace_some(ec_pipeline *p, const ec_rare_lights *lights, uint32_t most, uint32_t each, bool has_vertices, ec_chains *chains,
                            ec_joined_choice *choice, ec_error *err)
{
    const uint32_t paths = ec_look_paths(p, most), wave = p->wave < paths ? p->wave : paths;
    tracer t = {.p = p, .lights = lights, .found = chains, .room = each * paths};
    *chains = (ec_chains){.paths = paths, .chains = malloc((t.room + (size_t)1) * sizeof *chains->chains),
                          .visits = calloc(lights->material_count + (size_t)1, sizeof *chains->visits)};
    if (has_vertices) chains->vertices = malloc((size_t)EC_CHAIN_VERTICES * paths * sizeof *chains->vertices);
    t.at = malloc(4ull * wave);
    t.last = malloc(8ull * wave);
    t.wide = malloc(wave);
    t.queue = malloc(4ull * (wave + p->params.part) * EC_PATH_FIELDS);
    t.hits = malloc(4ull * (wave + p->params.part));
    ec_result result = ec_joined_open(&t.joined, lights->flux, paths, err);
    if (result == EC_OK && (!chains->chains || (has_vertices && !chains->vertices) || !chains->visits || !t.at || !t.last || !t.wide || !t.queue || !t.hits))
        result = ec_fail(err, "out of memory for %u paths", paths);
    t.look = (ec_look){.p = p, .paths = paths, .each = t.joined.paths ? 2 : 1, .replicates = 1, .bounces = bounces_of(p, lights->sky_count > 0, has_vertices), .samples_light = t.joined.paths,
                       .met = met, .shaded = shaded, .lit = lit, .user = &t};
    if (result == EC_OK) result = ec_look_trace(&t.look, err);
    if (result == EC_OK) *choice = ec_joined_choose(&t.joined, paths);
    ec_joined_close(&t.joined);
    free(t.at);
    free(t.last);
    free(t.wide);
    free(t.queue);
    free(t.hits);
    return result;
}

ec_result ec_chains_trace(ec_pipeline *p, const ec_rare_lights *lights, bool has_vertices, ec_chains *chains, ec_error *err)
{
    ec_joined_choice first = {0};
    const ec_result result = trace_some(p, lights, EC_CHAIN_PATHS, CHAINS_EACH, has_vertices, chains, &first, err);
    chains->may_join = first.may;
    return result;
}

ec_result ec_chains_join(ec_pipeline *p, const ec_rare_lights *lights, ec_joined_choice *joined, ec_error *err)
{
    ec_chains chains = {0};
    const ec_result result = trace_some(p, lights, EC_JOINED_PATHS, 0, false, &chains, joined, err);
    ec_chains_free(&chains);
    return result;
}

void ec_chains_free(ec_chains *chains)
{
    free(chains->chains);
    free(chains->vertices);
    free(chains->visits);
    *chains = (ec_chains){0};
}

/* Traces a queue of rays alone, part after part as fill_parts has them, at the time when the shutter opens. Lanes past the last ray repeat it. */
static ec_result meet_wave(ec_pipeline *p, ec_chain *rays, uint32_t count, float *fields, ec_error *err)
{
    const uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_BOUNCE] = 1};
    const uint32_t padded = (count + LANES_MOST - 1) / LANES_MOST * LANES_MOST, entries = padded < p->wave ? padded : p->wave;
    ec_counters *counters = &p->counters;
    ec_pipeline_fill_parts(p, count);
    ec_pipeline_swap_queues(p, 0);
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_clear(counters, 0), counters, err));
    for (uint32_t f = 0; f <= EC_PATH_PRIM; f++)
        for (uint32_t i = 0; i < entries; i++) {
            const uint32_t k = f < EC_PATH_DX ? f : f - EC_PATH_DX;
            const ec_chain *ray = &rays[i < count ? i : count - 1];
            float *to = &fields[(size_t)f * entries + i];
            if (f < EC_PATH_DX) *to = ray->origin[k];
            else if (f < EC_PATH_BR) *to = ray->direction[k];
            else memcpy(to, f == EC_PATH_PRIM ? &ray->prim : &i, sizeof i); /* slots, and fields that nobody reads */
        }
    EC_TRY(ec_buffer_write_rows(p->cl, p->buffers[EC_ARG_PATHS], 4ull * p->wave, 4ull * entries, EC_PATH_PRIM + 1, fields, err));
    if (p->buffers[EC_ARG_TIMES]) EC_TRY(ec_buffer_zero(p->cl, p->buffers[EC_ARG_TIMES], 0, 4ull * entries, err));
    EC_TRY(ec_pipeline_launch_trace(p, 0, ec_look_accel(p), scalars, err));
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_HITS], 4ull * p->wave * EC_HIT_PRIM, 4ull * count, fields, err));
    for (uint32_t i = 0; i < count; i++) memcpy(&rays[i].hit, &fields[i], sizeof rays[i].hit);
    return EC_OK;
}

ec_result ec_chains_meet(ec_pipeline *p, ec_chain *rays, uint32_t count, ec_error *err)
{
    const uint32_t most = count < p->wave ? count : p->wave;
    float *fields = malloc(4ull * (EC_PATH_PRIM + 1) * (most + LANES_MOST));
    ec_result result = fields ? EC_OK : ec_fail(err, "out of memory for %u rays", count);
    for (uint32_t first = 0, wave; result == EC_OK && first < count; first += wave) {
        wave = count - first < p->wave ? count - first : p->wave;
        result = meet_wave(p, rays + first, wave, fields, err);
    }
    free(fields);
    return result;
}
