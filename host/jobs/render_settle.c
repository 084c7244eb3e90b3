/* What follows from a render's options once all are read, and what does not go together. */
#include <inttypes.h>

#include "jobs/combinations.h"
#include "jobs/defaults.h"
#include "jobs/render_request.h"
#include "jobs/usage.h"

/* Where so many samples of the job end: batches, and what its last one lacks of that number. False within a batch. */
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

/* Slices begin and end with a batch, or end with the job. Before every replicate has a batch none does: the first-hit features are the mean
 * of all of these, taken one after the other. */
static ec_result settle_slice(ec_render_request *request, ec_error *err)
{
    ec_render_options *o = &request->options;
    if (!request->has_slice) return EC_OK;
    if (request->adaptive == EC_ADAPTIVE_ON) return ec_usage(err, "--samples and --adaptive: what a pixel is due there depends on the samples before; leave one out");
    if (o->error_target > 0)
        return ec_usage(err, "--samples and --error: a slice does not know the error of the whole; leave one out");
    if (o->spp == 0) request->slice_of_any = true, o->spp = request->slice_end;
    const uint32_t a = request->slice_first, b = request->slice_end, replicates = ec_render_replicates(o);
    if (b > o->spp)
        return ec_usage(err, "--samples %u:%u reaches beyond the job's %u samples a pixel; give the whole job's --spp", a, b, o->spp);
    uint32_t cut;
    const bool begins = find_end(o, a, &o->slice_first, &cut) && cut == 0 && (a == 0 || a >= replicates);
    const bool ends = find_end(o, b, &o->slice_end, &request->slice_cut) && (b >= replicates || b == o->spp);
    if (begins && ends) return EC_OK;
    const uint64_t from = a < replicates ? 0 : ec_schedule_samples(replicates, o->slice_first - (cut > 0));
    uint64_t to = b < replicates ? replicates : ec_schedule_samples(replicates, o->slice_end);
    if (to > o->spp) to = o->spp;
    return ec_usage(err, "--samples %u:%u: slices begin and end with a batch, here as %" PRIu64 ":%" PRIu64 "; multiples of %u always do", a, b, from, to,
                    EC_BATCH_MOST);
}

/* By itself where an error is asked for, and the samples of every pixel may differ. */
static ec_result settle_adaptive(ec_render_request *request, ec_error *err)
{
    ec_render_options *o = &request->options;
    o->adaptive = request->adaptive == EC_ADAPTIVE_ON || (request->adaptive == EC_ADAPTIVE_AUTO && o->error_target > 0);
    if (o->adaptive && ec_render_replicates(o) < 2)
        return ec_usage(err, "--adaptive and --replicates 1: a single replicate does not tell where noise is; give 2 or more");
    return EC_OK;
}

/* A frame is done or not: it is the sequence that goes on. */
static ec_result settle_frames(ec_render_request *request, ec_error *err)
{
    if (!request->frames.given && request->overwrite)
        return ec_usage(err, "--overwrite belongs to --frames; other pictures are written over as ever");
    if (!request->frames.given && request->frames.fps > 0)
        return ec_usage(err, "--fps belongs to --frames; leave it out or give that too");
    if (!request->frames.given && request->seed_is_frame) return ec_usage(err, "--seed frame belongs to --frames; give a number");
    if (!request->frames.given) return EC_OK;
    if (request->choice.at_given) return ec_usage(err, "--frames and --at: frame F is shown at F / --fps seconds; leave --at out");
    const char *other = request->resume ? "resume" : request->checkpoint ? "checkpoint" : request->has_slice ? "samples" : NULL;
    if (other) return ec_usage(err, "--frames and --%s: a sequence goes on with the frames that are not there yet; leave --%s out", other, other);
    if (request->frames.fps == 0) request->frames.fps = EC_DEFAULT_FPS;
    return EC_OK;
}

bool ec_render_has_limit(const ec_render_options *o) { return o->spp || o->time_limit > 0 || o->error_target > 0; }

ec_result ec_render_request_settle(ec_render_request *request, const ec_option *options, int count, const bool *given,
                                   ec_error *err)
{
    ec_render_options *limits = &request->options;
    if (limits->integrator == EC_INTEGRATOR_WHITTED && !limits->max_depth && !request->endless)
        limits->max_depth = EC_WHITTED_DEPTH;
    EC_TRY(ec_combinations_check_shutter(&request->choice, err));
    EC_TRY(ec_combinations_check(options, count, given, limits, err));
    if (request->every > 0 && !request->checkpoint)
        return ec_usage(err, "--every belongs to --checkpoint; leave it out or give that too");
    if (request->every == 0) request->every = EC_DEFAULT_EVERY;
    EC_TRY(settle_frames(request, err));
    EC_TRY(settle_slice(request, err));
    EC_TRY(settle_adaptive(request, err));
    request->capped = limits->spp == 0 && ec_render_has_limit(limits);
    if (!ec_render_has_limit(limits)) limits->spp = EC_DEFAULT_SPP;
    return EC_OK;
}

/* What cannot be had strip by strip. */
const char *ec_render_whole_for(const ec_render_request *r)
{
    if (r->adaptive == EC_ADAPTIVE_ON) return "--adaptive"; /* the allotment looks at all pixels */
    if (r->options.error_target > 0) return "--error"; /* of the whole image */
    if (r->options.time_limit > 0 || r->capped) return "--time";
    if (r->resume) return "--resume";
    if (r->checkpoint) return "--checkpoint";
    return r->has_slice ? "--samples" : NULL;
}
