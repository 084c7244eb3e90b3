#include "render/session.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/random.h"
#include "device/lamp_edges.h"
#include "device/light_batch.h"
#include "device/tiers.h"
#include "rare/light_share.h"
#include "rare/paths.h"

struct ec_session {
    ec_pipeline pipeline;
    ec_render_options options;
    ec_insides insides;          /* the media that a camera can be inside of */
    ec_rare_lights lights;
    ec_environment environment;  /* turned as in the scene; without texels */
    double rate;                 /* samples a second of the last waves; 0: not known */
    float *room;                 /* for a batch, where its colours alone are wanted, of room_pixels pixels */
    uint64_t room_pixels;
};

ec_result ec_session_open(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t largest,
                          ec_session **session, ec_render_stats *stats, ec_error *err)
{
    ec_session *s = calloc(1, sizeof *s);
    *session = s;
    *stats = (ec_render_stats){0};
    if (!s) return ec_fail(err, "out of memory for a pipeline");
    ec_payload payload;
    double share;
    ec_result result = ec_payload_make(scene, options, largest, 1u << ec_device_kind_of(&cl->info), cl, &payload, stats, err);
    s->insides = payload.insides;
    payload.insides = (ec_insides){0};
    if (result == EC_OK && options->integrator == EC_INTEGRATOR_PATH) result = ec_rare_lights_find(&payload.pack, &s->lights, err);
    if (result == EC_OK) result = ec_pipeline_create(cl, &payload, &payload, &s->pipeline, stats, err);
    ec_payload_free(&payload);
    const uint64_t pixels = (uint64_t)options->width * options->height;
    if (result == EC_OK) result = ec_pipeline_fit_films(&s->pipeline, pixels, pixels, err);
    const ec_params *params = &s->pipeline.params;
    s->options = *options;
    s->environment.turned = params->environment_turned;
    for (int k = 0; k < 9; k++) s->environment.turn[k] = params->environment_turn[k / 3 * 4 + k % 3];
    if (result == EC_OK && !(options->far_share > 0)) result = ec_light_share_choose(&s->pipeline, &share, err);
    if (result == EC_OK) result = ec_lamp_edges_find(&s->pipeline, err);
    stats->device_bytes = cl->peak_allocated_bytes;
    if (result == EC_OK) return EC_OK;
    ec_session_close(s);
    *session = NULL;
    return result;
}

void ec_session_close(ec_session *session)
{
    if (!session) return;
    ec_pipeline_destroy(&session->pipeline);
    ec_insides_free(&session->insides);
    ec_rare_lights_free(&session->lights);
    free(session->room);
    free(session);
}

uint32_t ec_session_largest(const ec_session *session) { return session->pipeline.room; }

ec_result ec_session_look(ec_session *s, const ec_session_view *view, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    ec_params *params = &p->params;
    ec_environment e = s->environment;
    s->options.width = params->width = view->width;
    s->options.height = params->height = params->film_rows = view->height;
    if (params->light_paths > 0) params->light_paths = ec_light_paths_a_pixel(s->options.light_paths, view->width, view->height);
    EC_TRY(ec_pipeline_set_camera(&view->camera, &s->options, params, err));
    params->camera_medium = ec_insides_of(&s->insides, &view->camera);
    ec_environment_turn(&e, view->env_degrees);
    if (p->buffers[EC_ARG_ENVIRONMENT_TEXELS]) {
        params->environment_turned = e.turned;
        for (int k = 0; k < 9; k++) params->environment_turn[k / 3 * 4 + k % 3] = e.turn[k];
    }
    ec_raster_forget(p);
    const uint64_t pixels = (uint64_t)view->width * view->height;
    EC_TRY(ec_pipeline_fit_films(p, pixels, pixels, err));
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof *params, params, err));
    return ec_lamp_edges_find(p, err);
}

ec_result ec_session_predict(ec_session *s, ec_rare *rare, ec_error *err)
{
    return ec_rare_paths_predict(&s->lights, &s->pipeline, rare, NULL, err);
}

static ec_result set_batch(ec_pipeline *p, const ec_session_batch *batch, ec_error *err)
{
    if (p->params.batch == batch->samples && p->params.first_sample == batch->first) return EC_OK;
    p->params.batch = batch->samples;
    p->params.first_sample = batch->first;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

static uint64_t drop_invalid(float *values, uint64_t pixels)
{
    uint64_t invalid = 0;
    for (uint64_t i = 0; i < EC_BATCH_FIELDS * pixels; i++) {
        if (isfinite(values[i])) continue;
        values[i] = 0.0f;
        invalid += i % EC_BATCH_FIELDS < EC_BATCH_LARGEST;
    }
    return invalid;
}

static float *room_for(ec_session *s, uint64_t pixels)
{
    if (pixels <= s->room_pixels) return s->room;
    free(s->room);
    s->room = malloc(pixels * EC_BATCH_FIELDS * sizeof *s->room);
    s->room_pixels = s->room ? pixels : 0;
    return s->room;
}

static ec_result read_results(ec_session *s, ec_session_batch *batch, uint64_t pixels, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    float *values = batch->batch ? batch->batch : room_for(s, pixels);
    if (!values) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, pixels * 4 * EC_BATCH_FIELDS, values, err));
    batch->invalid = drop_invalid(values, pixels);
    for (uint64_t i = 0; batch->rgb && i < pixels; i++)
        for (uint64_t c = 0; c < 3; c++) batch->rgb[3 * i + c] = values[EC_BATCH_FIELDS * i + c];
    if (!batch->features) return EC_OK;
    return ec_buffer_read(p->cl, p->buffers[EC_ARG_FEATURE_FILM], 0, pixels * 4 * EC_AOV_FIELDS, batch->features, err);
}

/* Returns how many pixels a wave has that ends within the slice. The first wave finds out how fast the device is. */
static uint32_t pixels_a_wave(const ec_session *s, const ec_session_batch *batch)
{
    uint32_t most = s->pipeline.wave / batch->samples;
    const double first = 4096;
    if (batch->slice <= 0) return most;
    double fits = (s->rate > 0 ? s->rate * batch->slice : first) / batch->samples;
    return fits < 64 ? most < 64 ? most : 64 : fits < most ? (uint32_t)fits : most;
}

static ec_result take_wave(ec_session *s, const ec_session_batch *batch, uint32_t first, uint32_t count, ec_error *err)
{
    double start = ec_now();
    const ec_params *params = &s->pipeline.params;
    const uint32_t numbers = batch->replicate * params->width * params->height; /* kernels/lib/film.h */
    EC_TRY(ec_pipeline_run_wave(&s->pipeline, batch->seed, numbers + first, count, batch->features != NULL, err));
    if (batch->slice <= 0) return EC_OK;
    EC_TRY(ec_cl_finish(s->pipeline.cl, err)); /* else the next waves would be queued before go_on has answered */
    double rate = (double)count * batch->samples / (ec_now() - start + 1e-9);
    s->rate = s->rate > 0 ? 0.7 * s->rate + 0.3 * rate : rate;
    return EC_OK;
}

double ec_session_rate(const ec_session *session) { return session->rate; }

ec_result ec_session_take(ec_session *session, ec_session_batch *batch, ec_error *err)
{
    ec_pipeline *p = &session->pipeline;
    uint32_t pixels = p->params.width * p->params.height;
    double start = ec_now();
    bool go_on;
    batch->complete = false;
    EC_TRY(set_batch(p, batch, err));
    EC_TRY(ec_light_batch_run(p, ec_light_path_seed(batch->seed, batch->replicate), batch->go_on, batch->user, &go_on, err));
    if (!go_on) return ec_cl_finish(p->cl, err);
    for (uint32_t first = 0, count; first < pixels; first += count) {
        if (batch->go_on && !batch->go_on(batch->user)) return ec_cl_finish(p->cl, err);
        EC_TRY(ec_tiers_step(p, err));
        count = pixels_a_wave(session, batch);
        if (count > pixels - first) count = pixels - first;
        EC_TRY(ec_lamp_edges_prepare(p, NULL, batch->replicate * pixels + first, &count, err));
        EC_TRY(take_wave(session, batch, first, count, err));
    }
    EC_TRY(read_results(session, batch, pixels, err));
    batch->seconds = ec_now() - start;
    batch->complete = true;
    return EC_OK;
}

ec_result ec_session_invalid(ec_session *session, uint64_t *samples, ec_error *err)
{
    uint32_t invalid[EC_STAGE_COUNT];
    EC_TRY(ec_pipeline_read_invalid(&session->pipeline, invalid, err));
    *samples = 0;
    for (int i = 0; i < EC_STAGE_COUNT; i++) *samples += invalid[i];
    return EC_OK;
}

uint32_t ec_session_seed(uint64_t seed, uint32_t stream, uint32_t index)
{
    uint64_t state = seed ^ UINT64_C(0x65636c6174);
    state = ec_random_bits(&state) ^ ((uint64_t)stream << 32 | index);
    return (uint32_t)(ec_random_bits(&state) >> 16);
}
