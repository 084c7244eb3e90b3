/* Runs a render from set-up to the end. */
#include "render/render.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "device/adaptive.h"
#include "film/layer_films.h"
#include "pack/pack.h"
#include "rare/light_share.h"
#include "render/render_state.h"

/* Fails if nothing would end a path, also where survival is not a probability at all. Only paths use it: ray trees have a depth of their own,
 * rasterised pictures none. */
static ec_result check_ends(const ec_render_options *o, ec_error *err)
{
    bool ends = (o->survival >= 0.0 && o->survival < 1.0) || o->max_depth;
    if (!ec_traces_paths(o->integrator) || ends) return EC_OK;
    return ec_fail(err, "a survival probability of %g with unlimited depth would never end a path; set max_depth, or a survival under 1", o->survival);
}

/* Notes effects of --without that the scene does not call for: no option is without effect in silence. */
static ec_result note_unneeded(const ec_scene *scene, uint64_t without, const ec_log *log, ec_error *err)
{
    ec_effects effects;
    char names[EC_EFFECT_NAMES];
    if (!without) return EC_OK;
    EC_TRY(ec_scene_calls(scene, &effects, err));
    ec_feature_names(without & ~effects.bits, names, sizeof names);
    if (*names) ec_note(log, "--without: the scene does not call for %s", names);
    return EC_OK;
}

static void count_from(ec_render_state *r, const ec_past *past)
{
    r->rays_before = past ? past->rays : 0;
    for (int i = 0; i < EC_STAGE_COUNT; i++) r->invalid_before[i] = past ? past->invalid[i] : 0;
}

/* Takes over the film and figures of the course's past, if it has one. */
static void take_up(ec_render_state *r, const ec_past *past)
{
    r->past.allotment.gain = 1.0;
    r->past.next = r->kept_next = r->course->first;
    if (!past) return;
    r->past = *past;
    r->past.allotment.weight = NULL;
    count_from(r, past);
    r->kept_next = r->course->past_is_kept ? past->next : UINT32_MAX; /* no batch has that number, so all is new to `keep` */
    r->kept_under_way = past->under_way;
}

/* Chooses strips once the only device is loaded, since its films have to fit beside that, and prepares the film; several devices take all rows. */
static ec_result choose_film(ec_render_state *r, const ec_log *log, ec_error *err)
{
    const ec_pipeline *alone = ec_sources_alone(&r->sources);
    if (alone) EC_TRY(ec_render_choose_rows(r, log, err));
    if (!r->course->past && !r->strip_rows) EC_TRY(ec_film_create(r->film, r->options->width, r->options->height, r->replicates, err));
    if (!r->course->past && !r->strip_rows) ec_film_want_features(r->film, ec_render_feature_sets(r->options), ec_render_feature_end(r->options));
    if (!r->course->past && !r->strip_rows) EC_TRY(ec_film_set_layers(r->film, &r->options->layers, err));
    if (!r->strip_rows) EC_TRY(ec_film_set_rare(r->film, &r->rare, err));
    if (!r->course->past && !r->strip_rows && r->options->adaptive && r->params.light_paths > 0) EC_TRY(ec_film_part_light(r->film, err));
    if (!alone) return EC_OK;
    if (!r->strip_rows) EC_TRY(r->source->turn_to(r->source, 0, r->options->height, err));
    r->stats->wave = alone->room;
    if (alone->room < alone->first_room)
        ec_note(log, "the device has memory for a wave of %u paths, not of %u; --wave sets the size", alone->room, alone->first_room);
    return EC_OK;
}

/* Sets the end: after so many samples a pixel, of the job or of its slice. */
static void choose_end(ec_render_state *r)
{
    const ec_render_options *o = r->options;
    const ec_course *course = r->course;
    const uint64_t most = o->spp ? o->spp : course->most;
    uint32_t before = 0;
    r->end = UINT32_MAX;
    if (course->end) r->end = course->end - (course->cut > 0), r->cut = course->cut;
    else if (most) r->end = ec_schedule_find(r->replicates, most, &before);
    if (before) r->cut = ec_schedule_batch(r->replicates, r->end).samples - before;
    double samples = (double)most;
    if (course->end)
        samples = (double)(ec_schedule_samples(r->replicates, course->end) - ec_schedule_samples(r->replicates, course->first)) - course->cut;
    ec_goal_set(&r->goal, samples, o->time_limit, o->error_target);
}

/* Returns the samples of the largest batch, which a wave has to hold. Pixels of an adaptive render may get many times the mean. */
static uint32_t largest_batch(const ec_render_state *r)
{
    const bool is_known = r->end != UINT32_MAX && !r->options->adaptive;
    return is_known ? ec_schedule_batch(r->replicates, r->end ? r->end - (r->cut == 0) : 0).samples : EC_BATCH_MOST;
}

static ec_result open_sources(ec_render_state *r, const ec_peers *peers, const ec_log *log, ec_error *err)
{
    if (ec_traces_paths(r->options->integrator)) /* rasterised pictures and ray trees take the same paths whatever the sample */
        EC_TRY(ec_rare_lights_find(&r->sources.payload.pack, &r->lights, err));
    return ec_sources_open(&r->sources, r->options->seed, peers, log, &r->source, r->stats, err);
}

/* Notes which options leave out scattering in bodies. */
static void tell_scattering(const ec_render_options *o, const ec_log *log)
{
    if (o->integrator != EC_INTEGRATOR_PATH)
        ec_note(log, "bodies absorb the light that they would scatter; only --integrator path scatters light inside bodies");
    else if (o->light_paths > 0)
        ec_note(log, "--light-paths: none are traced, since light scatters inside bodies in this scene, and light paths do not");
}

/* Notes what light paths leave out. */
static void tell_unjoined(const ec_render_options *o, uint64_t called, const ec_log *log)
{
    if (o->integrator == EC_INTEGRATOR_LIGHT && (called & (EC_FEATURE_SMOOTH | EC_FEATURE_TRANSMISSION)))
        ec_note(log, "what is seen in mirrors and through glass is missing: paths from the lights reach the camera only from surfaces that scatter");
}

/* Checks that the scene is what the course expects. */
static ec_result admit(ec_render_state *r, const ec_log *log, ec_error *err)
{
    const ec_past *past = r->course->past;
    const ec_payload_head *head = &r->sources.payload.head;
    if (head->bodies_too_many)
        ec_warn(log, "%u materials of glass or liquid, of which at most %u can be told apart, so each of their bodies refracts as if in air; give similar bodies one material",
                head->bodies_too_many, EC_BODIES_MOST);
    if (r->options->scattering == EC_SCATTERING_MULTIPLE && !(head->effects.called.bits & EC_FEATURE_MULTISCATTER))
        ec_note(log, "--scattering multiple: the scene has no rough metal or glass");
    if (head->effects.called.bits & EC_FEATURE_SCATTERING) tell_scattering(r->options, log);
    tell_unjoined(r->options, head->effects.called.bits, log);
    if (r->course->admit) EC_TRY(r->course->admit(r->course->user, r->stats, err));
    return past && past->allotment.weight ? ec_allotment_again(&past->allotment, &r->params, r->replicates, &r->past.allotment, err) : EC_OK;
}

/* Returns whether there are both lights at infinity and others, between which light samples are divided. */
static bool mixes_lights(const ec_render_options *o, const ec_scene *scene) { return o->integrator == EC_INTEGRATOR_PATH && ec_scene_mixes_lights(scene); }

/* Gives up what was loaded to judge by. */
static void begin_again(ec_render_state *r)
{
    ec_render_stats closed = {0};
    ec_rare_lights_free(&r->lights);
    ec_sources_close(&r->sources, &closed);
    r->sources = (ec_sources){.count = 0};
    r->is_predicted = false;
    count_from(r, r->course->past);
}

/* Sets light paths. Caustics that these cannot be joined to, in mirrors and glass, are found by guiding where they are rare. */
static void choose_light_paths(ec_render_state *r, ec_caustics caustics)
{
    if (!caustics) return;
    r->chosen.light_paths = caustics == EC_CAUSTICS_RARE ? EC_LIGHT_PATHS_RARE : r->joined.number;
    r->chosen.guiding |= caustics == EC_CAUSTICS_RARE;
}

/* Chooses what the options leave open, by the only source before the first sample. Light paths do not scatter inside bodies. */
static ec_result choose_open(ec_render_state *r, const ec_scene *scene, ec_caustics *caustics, const ec_log *log, ec_error *err)
{
    const bool follow = !(r->sources.payload.head.effects.called.bits & EC_FEATURE_SCATTERING);
    ec_pipeline *p = ec_sources_pipeline(&r->sources, 0, false);
    *caustics = EC_CAUSTICS_NONE;
    if (follow && ec_render_may_have_caustics(r->options, scene)) EC_TRY(ec_render_judge_caustics(r, caustics, log, err));
    r->chosen = *r->options;
    r->options = &r->chosen;
    choose_light_paths(r, *caustics);
    if (r->chosen.far_share > 0) return EC_OK;
    const double start = ec_cpu_now();
    EC_TRY(ec_light_share_choose(p, &r->chosen.far_share, err));
    r->look_cpu_seconds += ec_cpu_now() - start;
    return EC_OK;
}

/* Loads the devices. The first one alone judges what is open, and goes on with what is loaded if it renders alone and no other kernels are called
 * for. Several devices begin to work as they are loaded, so the look comes before that. */
static ec_result load(ec_render_state *r, ec_cl *devices, uint32_t count, const ec_scene *scene, const ec_log *log, ec_error *err)
{
    const ec_peers *peers = r->course->peers;
    const bool is_judged = ec_render_may_have_caustics(r->options, scene) || mixes_lights(r->options, scene), is_alone = count == 1 && !peers;
    const uint32_t first = is_judged ? 1 : count;
    ec_caustics caustics = EC_CAUSTICS_NONE;
    EC_TRY(ec_sources_pack(devices, first, peers != NULL && !is_judged, scene, r->options, largest_batch(r), &r->sources, r->stats, err));
    r->params = r->sources.payload.head.params;
    EC_TRY(admit(r, log, err));
    EC_TRY(open_sources(r, is_judged ? NULL : peers, log, err));
    if (is_judged) EC_TRY(choose_open(r, scene, &caustics, log, err));
    if (is_judged && (caustics || !is_alone)) {
        const ec_render_stats before = *r->stats;
        begin_again(r);
        EC_TRY(ec_sources_pack(devices, count, peers != NULL, scene, r->options, largest_batch(r), &r->sources, r->stats, err));
        r->params = r->sources.payload.head.params;
        EC_TRY(open_sources(r, peers, log, err));
        r->stats->pack_seconds += before.pack_seconds;
        r->stats->kernel_seconds += before.kernel_seconds;
    }
    return ec_sources_alone(&r->sources) ? EC_OK : ec_render_predict(r, err);
}

static ec_result set_up(ec_render_state *r, ec_cl *devices, uint32_t device_count, const ec_scene *scene,
                        const ec_log *log, ec_error *err)
{
    const ec_past *past = r->course->past;
    take_up(r, past);
    EC_TRY(load(r, devices, device_count, scene, log, err));
    const bool are_sent = r->sources.payload.head.effects.called.bits & EC_FEATURE_LIGHT_PATHS; /* not where light scatters inside bodies */
    r->stats->light_paths = are_sent ? fmax(r->options->light_paths, 0) : 0;
    r->stats->is_guided = r->options->guiding;
    r->stats->far_share = r->options->far_share;
    if (r->course->loaded && ec_sources_alone(&r->sources)) r->course->loaded(r->course->user);
    EC_TRY(choose_film(r, log, err));
    if (past) r->limit = r->film->limit;
    return r->strip_rows ? EC_OK : ec_render_find_limit(r, r->options->height, log, err);
}

static void tell_kernels(ec_render_state *r)
{
    const ec_pipeline *alone = ec_sources_alone(&r->sources);
    if (!alone) return;
    r->stats->begun = alone->begun;
    r->stats->keeps_kernels = alone->keeps_kernels;
    if (alone->fast_since > 0) r->stats->fast_after_seconds = alone->fast_since - r->start;
}

ec_result ec_render_course(ec_cl *devices, uint32_t device_count, const ec_scene *scene,
                           const ec_render_options *options, const ec_course *course, ec_progress_fn progress,
                           void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err)
{
    *stats = (ec_render_stats){.strips = 1};
    EC_TRY(check_ends(options, err));
    EC_TRY(note_unneeded(scene, options->without, log, err));
    ec_render_state r = {.options = options, .course = course, .progress = progress, .user = user, .film = film, .stats = stats, .start = ec_now(),
                         .matte_lock = PTHREAD_MUTEX_INITIALIZER};
    r.error.error = r.error.error_bound = r.error.relmse = INFINITY;
    r.replicates = ec_render_replicates(options);
    r.matte.lock = &r.matte_lock;
    r.goal.pixels = (double)options->width * options->height;
    r.goal.replicates = r.replicates;
    choose_end(&r);
    ec_result result = set_up(&r, devices, device_count, scene, log, err);
    if (result == EC_OK) {
        ec_error why = {0};
        r.cpu_start = ec_cpu_now();
        result = r.strip_rows ? ec_render_strips(&r, log, &why) : ec_render_film(&r, log, &why);
        stats->cpu_seconds = ec_cpu_now() - r.cpu_start + r.look_cpu_seconds;
        if (result != EC_OK) r.stopped_by = why.kind == EC_ERROR_OTHER ? "failure" : "device";
        if (result != EC_OK && err) *err = why;
        tell_kernels(&r);
        ec_render_finish_stats(&r);
    }
    ec_allotment_free(&r.past.allotment);
    free(r.layers);
    free(r.layer);
    free(r.matte.entries);
    pthread_mutex_destroy(&r.matte_lock);
    ec_rare_lights_free(&r.lights);
    ec_sources_close(&r.sources, stats);
    return result;
}

ec_result ec_render(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, ec_progress_fn progress,
                    void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err)
{
    const ec_course whole = {0};
    return ec_render_course(cl, 1, scene, options, &whole, progress, user, film, stats, log, err);
}
