/* Completes a render's options once all are read, and refuses those that do not go together, so that no option is silently without effect. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "denoise/judge.h"
#include "jobs/defaults.h"
#include "jobs/option.h"
#include "jobs/render_request.h"
#include "report/names.h"

static bool belongs(const ec_option *option, ec_integrator integrator)
{
    return option->integrators == 0 || (option->integrators >> integrator & 1);
}

bool ec_combinations_belongs(const char *option, ec_integrator integrator)
{
    const ec_option *row = ec_render_row(option);
    return !row || belongs(row, integrator);
}

static ec_result check_owner(const ec_option *option, ec_integrator integrator, ec_error *err)
{
    char names[128] = "";
    if (belongs(option, integrator)) return EC_OK;
    for (uint32_t k = 0; k < EC_INTEGRATOR_COUNT; k++) {
        if (!(option->integrators >> k & 1)) continue;
        const size_t used = strlen(names);
        const bool is_last = option->integrators >> k == 1;
        snprintf(names + used, sizeof names - used, "%s%s", !used ? "" : is_last ? " or " : ", ", ec_integrator_names[k]);
    }
    return ec_usage(err, "--%s belongs to --integrator %s; leave it out or choose that", option->name, names);
}

static ec_result check_plan(const ec_option *options, int count, const bool *given, ec_error *err)
{
    const ec_option *plan = ec_options_find(options, count, "plan");
    if (!plan || !given[plan - options]) return EC_OK;
    for (int i = 0; i < count; i++)
        if (given[i] && options[i].uses & EC_OPTION_PART)
            return ec_usage(err, "--plan and --%s: a plan needs one whole picture, from the first sample on; leave --%s out", options[i].name,
                            options[i].name);
    return EC_OK;
}

ec_result ec_combinations_check_grid(double density, const char *accel, bool takes_all, ec_error *err)
{
    bool fits = accel && (!strcmp(accel, "grid") || (takes_all && !strcmp(accel, "all")));
    if (density == 0 || fits) return EC_OK;
    return ec_usage(err, "--grid-density belongs to --accel grid%s; leave it out or choose that too", takes_all ? " or all" : "");
}

static ec_result check_shutter(const ec_scene_choice *choice, ec_error *err)
{
    if (!choice->shutter || !choice->at_given) return EC_OK;
    return ec_usage(err, "--at shows one moment, --shutter all from one to another; give one of them");
}

static ec_result check_combinations(const ec_option *options, int count, const bool *given, const ec_render_options *asked,
                                ec_error *err)
{
    for (int i = 0; i < count; i++)
        if (given[i]) EC_TRY(check_owner(&options[i], asked->integrator, err));
    EC_TRY(check_plan(options, count, given, err));
    if (asked->integrator == EC_INTEGRATOR_WHITTED && asked->max_depth > EC_WHITTED_DEPTH_MOST)
        return ec_usage(err, "--integrator whitted: a --max-depth of %u is too deep for trees that keep every branch; give at most %u",
                        asked->max_depth, EC_WHITTED_DEPTH_MOST);
    if (asked->integrator == EC_INTEGRATOR_WHITTED && asked->max_depth == 0)
        return ec_usage(err, "--max-depth inf belongs to --integrator path; a ray tree needs a number up to %u",
                        EC_WHITTED_DEPTH_MOST);
    EC_TRY(ec_combinations_check_grid((double)asked->grid_density, asked->accel, false, err));
    if (asked->filter_width > 0 && asked->filter == EC_FILTER_BOX)
        return ec_usage(err, "--filter-width belongs to --filter blackman-harris; leave it out or choose that");
    if ((asked->fstop > 0) != (asked->focus > 0))
        return ec_usage(err, "--fstop and --focus go together: how wide the lens is, and how far away it is sharp; give --%s too",
                        asked->fstop > 0 ? "focus" : "fstop");
    if (asked->light_paths > 0 && asked->sample != EC_SAMPLE_MIS)
        return ec_usage(err, "--light-paths and --sample %s: light paths are weighed against both other ways; leave one out", ec_sample_names[asked->sample]);
    if (asked->light_paths > 0 && asked->clamp > 0)
        return ec_usage(err, "--light-paths and --clamp: light paths add the light that --clamp would remove; leave one out");
    if (asked->integrator == EC_INTEGRATOR_LIGHT && asked->light_paths == 0)
        return ec_usage(err, "--integrator light and --light-paths 0: no path would be traced; leave one out");
    if (asked->guiding && asked->sample != EC_SAMPLE_MIS)
        return ec_usage(err, "--guiding and --sample %s: guided directions are weighed against light sampling; leave one out", ec_sample_names[asked->sample]);
    if (asked->survival == 1 && asked->max_depth == 0)
        return ec_usage(err, "--rr off belongs with a finite --max-depth: nothing else would end a path; give --max-depth N too");
    return EC_OK;
}

/* Finds where this many samples of the job end: *batch batches, the last of which is *cut samples short. Returns false if that is within a batch. */
static bool find_end(const ec_render_options *o, uint32_t samples, uint32_t *batch, uint32_t *cut)
{
    const uint32_t replicates = ec_render_replicates(o);
    uint32_t before;
    *batch = ec_schedule_find(replicates, samples, &before);
    *cut = 0;
    if (before == 0) return true;
    *cut = ec_schedule_batch(replicates, *batch).samples - before;
    ++*batch;
    return samples == o->spp;
}

/* Checks that a slice begins with a batch, and ends with a batch or with the job. It may not begin or end among the batches that contribute to
 * first-hit features, which are a mean over all of these, taken in order. */
static ec_result settle_slice(ec_render_request *request, ec_error *err)
{
    ec_render_options *o = &request->options;
    if (!request->has_slice) return EC_OK;
    if (request->adaptive == EC_ADAPTIVE_ON) return ec_usage(err, "--samples and --adaptive: how many samples a pixel gets depends on earlier ones, which a slice does not have; leave one out");
    if (o->error_target > 0)
        return ec_usage(err, "--samples and --error: a slice does not know the error of the whole; leave one out");
    if (o->spp == 0) request->slice_of_any = true, o->spp = request->slice_end;
    const uint32_t a = request->slice_first, b = request->slice_end, replicates = ec_render_replicates(o);
    const uint64_t features = ec_schedule_samples(replicates, ec_schedule_features(replicates));
    if (b > o->spp)
        return ec_usage(err, "--samples %u:%u reaches beyond the job's %u samples a pixel; give the whole job's --spp", a, b, o->spp);
    uint32_t cut;
    const bool begins = find_end(o, a, &o->slice_first, &cut) && cut == 0 && (a == 0 || a >= features);
    const bool ends = find_end(o, b, &o->slice_end, &request->slice_cut) && (b >= features || b == o->spp);
    if (begins && ends) return EC_OK;
    const uint64_t from = a < features ? 0 : ec_schedule_samples(replicates, o->slice_first - (cut > 0));
    uint64_t to = b < features ? features : ec_schedule_samples(replicates, o->slice_end);
    if (to > o->spp) to = o->spp;
    return ec_usage(err, "--samples %u:%u: slices begin and end with a batch, here as %" PRIu64 ":%" PRIu64 "; multiples of %u always do", a, b, from, to,
                    EC_BATCH_MOST);
}

/* Turns adaptive sampling on by itself if an error is asked for and the integrator allows it. */
static ec_result settle_adaptive(ec_render_request *request, ec_error *err)
{
    ec_render_options *o = &request->options;
    if (o->integrator == EC_INTEGRATOR_LIGHT && request->adaptive == EC_ADAPTIVE_ON)
        return ec_usage(err, "--integrator light and --adaptive: light paths cannot be aimed at chosen pixels; leave one out");
    o->adaptive = request->adaptive == EC_ADAPTIVE_ON || (request->adaptive == EC_ADAPTIVE_AUTO && o->error_target > 0 && o->integrator != EC_INTEGRATOR_LIGHT);
    if (o->adaptive && ec_render_replicates(o) < 2)
        return ec_usage(err, "--adaptive and --replicates 1: a single replicate does not tell where noise is; give 2 or more");
    return EC_OK;
}

/* Turns automatic light paths off if other options exclude them. */
static void settle_light_paths(ec_render_request *request)
{
    ec_render_options *o = &request->options;
    const bool can = o->integrator == EC_INTEGRATOR_PATH && o->sample == EC_SAMPLE_MIS && !(o->clamp > 0) && !o->layers.kinds && !request->light_groups;
    if (o->light_paths == EC_LIGHT_PATHS_AUTO && !can) o->light_paths = 0;
}

/* Checks --ground=shadow: the shadow becomes part of the alpha of the whole picture. */
static ec_result check_ground(const ec_render_request *request, ec_error *err)
{
    if (request->ground != EC_GROUND_SHADOW) return EC_OK;
    if (request->options.integrator != EC_INTEGRATOR_PATH) return ec_usage(err, "--ground=shadow belongs to --integrator path; leave it out or choose that");
    if (!request->options.hides_environment)
        return ec_usage(err, "--ground=shadow: the environment would hide the shadow; give --background transparent, a colour or blur");
    return EC_OK;
}

static ec_result settle_denoise(const ec_render_request *request, ec_error *err)
{
    const uint32_t replicates = ec_render_replicates(&request->options);
    if (!request->options.denoise) return EC_OK;
    if (replicates < EC_JUDGE_REPLICATES)
        return ec_usage(err, "--denoise and --replicates %u: one half of the replicates judges the other; give %d or more", replicates, EC_JUDGE_REPLICATES);
    return EC_OK;
}

/* Checks options of sequences. Frames are rendered whole or not at all: a sequence goes on, a frame does not. */
static ec_result settle_frames(ec_render_request *request, ec_error *err)
{
    if (request->orbit && !request->frames.given)
        request->frames = (ec_frame_range){.given = true, .last = request->orbit - 1, .step = 1, .fps = request->frames.fps};
    if (!request->frames.given && request->overwrite)
        return ec_usage(err, "--overwrite works with --frames only; other pictures are always replaced");
    if (!request->frames.given && request->frames.fps > 0)
        return ec_usage(err, "--fps belongs to --frames; leave it out or give that too");
    if (!request->frames.given && request->seed_is_frame) return ec_usage(err, "--seed frame belongs to --frames; give a number");
    if (!request->frames.given) return EC_OK;
    if (request->orbit && request->frames.last >= request->orbit)
        return ec_usage(err, "--frames ends with %u, and --orbit %u has the frames 0 to %u", request->frames.last, request->orbit, request->orbit - 1);
    const bool is_still = request->orbit && request->frames.fps == 0;
    if (request->choice.at_given && !is_still) return ec_usage(err, "--frames and --at: frame F is shown at F / --fps seconds; leave --at out");
    const char *other = request->resume ? "resume" : request->checkpoint ? "checkpoint" : request->has_slice ? "samples" : request->snapshot ? "snapshot" : NULL;
    if (other) return ec_usage(err, "--frames and --%s: the same command, run again, continues a sequence that was interrupted; leave --%s out", other, other);
    if (request->frames.fps == 0 && !is_still) request->frames.fps = EC_DEFAULT_FPS;
    return EC_OK;
}

static ec_result check_scenarios(const ec_render_request *request, ec_error *err)
{
    if (!request->scenarios && request->folder) return ec_usage(err, "--out belongs to --scenarios; other pictures are named with -o");
    if (!request->scenarios) return EC_OK;
    if (!request->folder || !*request->folder) return ec_usage(err, "--scenarios needs --out FOLDER, for its pictures");
    if (request->outputs.count) return ec_usage(err, "--scenarios and -o: each picture is named after its scenario, in the folder of --out; leave -o out");
    if (request->frames.given) return ec_usage(err, "--scenarios and --frames: a scenario is one picture, from one place; leave --frames and --orbit out");
    return EC_OK;
}

/* Tells whether an EXR is written, as it is by default. */
static bool writes_exr(const ec_outputs *outputs) { return outputs->count == 0 || ec_outputs_have_exr(outputs); }

/* Refuses --channels where it would have no effect. */
static ec_result settle_channels(const ec_render_request *request, ec_error *err)
{
    if (!request->channels) return EC_OK;
    if (request->has_slice && request->channels & ec_channels_all() & ~ec_channels_of(EC_PLANE_RGB))
        return ec_usage(err, "--samples and --channels: a slice holds all of them; name only layers, such as direct, or leave --channels out");
    return writes_exr(&request->outputs) ? EC_OK : ec_usage(err, "--channels belongs to an EXR, and -o names none; leave it out or write one too");
}

/* Finds layers and mattes, and refuses options that do not go with them. */
static ec_result settle_layers(ec_render_request *request, ec_error *err)
{
    ec_render_options *o = &request->options;
    const uint32_t of_light = 1u << EC_LAYER_DIRECT | 1u << EC_LAYER_INDIRECT;
    o->layers.kinds = ec_channels_layers(request->channels);
    o->layers.mattes = ec_channels_mattes(request->channels);
    const bool any_light = request->light_groups || (o->layers.kinds & of_light);
    const char *what = request->light_groups ? "light-groups" : any_light ? "channels direct or indirect" : o->layers.kinds ? "channels position, uv or motion" : "channels cryptomatte";
    if (!any_light && !o->layers.kinds && !o->layers.mattes) return EC_OK;
    const char *keeps = request->checkpoint ? "checkpoint" : request->resume ? "resume" : request->has_slice ? "samples" : NULL;
    const char *other = request->snapshot ? "snapshot" : o->layers.mattes ? keeps : NULL;
    if (other) return ec_usage(err, "--%s and --%s: checkpoints, slices and snapshots do not store these layers; leave one out", o->layers.mattes ? "channels cryptomatte" : what, other);
    if (o->clamp > 0) return ec_usage(err, "--%s and --clamp: a clamp takes light from the sum, and no layer says which; leave one out", what);
    if (any_light && o->light_paths > 0) return ec_usage(err, "--%s and --light-paths: light paths have no layers; leave one out", what);
    if (any_light && o->integrator != EC_INTEGRATOR_PATH) return ec_usage(err, "--%s belongs to --integrator path; leave it out or choose that", what);
    if (o->layers.kinds >> EC_LAYER_MOTION & 1 && !request->choice.shutter)
        return ec_usage(err, "--channels motion tells how far things go while the shutter is open; give --shutter A:B too");
    if (o->wave > EC_LAYER_WAVE_MOST) return ec_usage(err, "--%s: --wave can be %u at most; give fewer", what, EC_LAYER_WAVE_MOST);
    return writes_exr(&request->outputs) ? EC_OK : ec_usage(err, "--%s: only an EXR has layers, and -o names none; write one too", what);
}

/* Checks --ocio, whose views are for pictures shown on a screen. */
static ec_result settle_ocio(const ec_render_request *request, const ec_option *options, int count, const bool *given, ec_error *err)
{
    const ec_option *curve = ec_options_find(options, count, "tonemap");
    const ec_ocio_choice *o = &request->ocio;
    const char *other = o->display ? "display" : o->view ? "view" : o->space ? "space" : NULL;
    if (!o->config) return other ? ec_usage(err, "--ocio-%s belongs to --ocio CONFIG; give that too", other) : EC_OK;
    return curve && given[curve - options] ? ec_usage(err, "--ocio and --tonemap: a view has a curve of its own; leave one out") : EC_OK;
}

/* Checks that the output formats can hold an alpha, and the identity of a frame. */
static ec_result settle_files(const ec_render_request *request, ec_error *err)
{
    const bool is_clear = request->background.kind == EC_BACKDROP_TRANSPARENT;
    if (request->has_slice && request->options.hides_environment) return ec_usage(err, "--background and --samples: eclat merge has no backgrounds; leave one out");
    for (int i = 0; i < request->outputs.count; i++) {
        const ec_format *format = ec_output_format(&request->outputs.file[i]);
        const char *path = request->outputs.file[i].path;
        if (format && is_clear && !format->has_alpha) return ec_usage(err, "--background transparent: '%s' has no alpha; write a .png or an .exr", path);
        if (format && request->frames.given && !format->keeps_text)
            return ec_usage(err, "--frames: '%s' cannot store the identity of the frame's job; write a .png or an .exr", path);
    }
    return EC_OK;
}

bool ec_render_has_limit(const ec_render_options *o) { return o->spp || o->time_limit > 0 || o->error_target > 0; }

ec_result ec_render_request_settle(ec_render_request *request, const ec_option *options, int count, const bool *given,
                                   ec_error *err)
{
    ec_render_options *limits = &request->options;
    if (limits->integrator == EC_INTEGRATOR_WHITTED && !limits->max_depth && !request->endless)
        limits->max_depth = EC_WHITTED_DEPTH;
    if (limits->integrator == EC_INTEGRATOR_LIGHT && limits->light_paths == EC_LIGHT_PATHS_AUTO) limits->light_paths = EC_LIGHT_PATHS_ALONE;
    EC_TRY(check_shutter(&request->choice, err));
    EC_TRY(check_combinations(options, count, given, limits, err));
    if (request->every > 0 && !request->checkpoint && !request->snapshot)
        return ec_usage(err, "--every belongs to --checkpoint or --snapshot; leave it out or give one of them too");
    if (request->every == 0) request->every = EC_DEFAULT_EVERY;
    EC_TRY(settle_frames(request, err));
    EC_TRY(check_scenarios(request, err));
    EC_TRY(settle_slice(request, err));
    EC_TRY(settle_channels(request, err));
    EC_TRY(settle_layers(request, err));
    EC_TRY(settle_files(request, err));
    EC_TRY(settle_ocio(request, options, count, given, err));
    EC_TRY(settle_adaptive(request, err));
    settle_light_paths(request);
    EC_TRY(settle_denoise(request, err));
    EC_TRY(check_ground(request, err));
    request->capped = limits->spp == 0 && ec_render_has_limit(limits);
    if (!ec_render_has_limit(limits)) limits->spp = EC_DEFAULT_SPP;
    return EC_OK;
}

/* Returns the option that prevents rendering strip by strip. */
const char *ec_render_whole_for(const ec_render_request *r)
{
    if (r->options.denoise) return "--denoise"; /* it looks at neighbouring pixels */
    if (r->adaptive == EC_ADAPTIVE_ON) return "--adaptive"; /* the allotment looks at all pixels */
    if (r->options.error_target > 0) return "--error"; /* it is the error of the whole image */
    if (r->options.time_limit > 0 || r->capped) return "--time";
    if (r->resume) return "--resume";
    if (r->ground == EC_GROUND_SHADOW) return "--ground=shadow"; /* it renders two more pictures */
    if (ec_channels_mattes(r->channels)) return "--channels cryptomatte"; /* mattes of each pixel are only final after the last sample */
    if (r->exposure.is_auto) return "--exposure auto"; /* it depends on all pixels */
    if (r->checkpoint) return "--checkpoint";
    if (r->snapshot) return "--snapshot";
    return r->has_slice ? "--samples" : NULL;
}
