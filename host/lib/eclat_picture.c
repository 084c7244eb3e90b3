#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/internal.h"
#include "report/error_text.h"

static const ec_picture *planes_of(const eclat_picture *p)
{
    const ec_call *call = &p->call;
    return p->planes.rgb ? &p->planes : call->merged.picture.rgb ? &call->merged.picture : &call->mix.picture;
}

static ec_result take_render(eclat_picture *p, ec_error *err)
{
    const char *names[EC_OUTPUTS_MAX];
    ec_render_job *job = &p->call.render;
    const ec_film *film = &job->film;
    EC_TRY(ec_render_job_denoise(job, err));
    EC_TRY(ec_picture_resolve(film, true, &p->planes, err));
    p->error = job->stats.film = ec_film_estimate_error(film);
    p->samples_per_pixel = (double)job->stats.samples / ((double)film->width * film->height);
    p->replicates = ec_film_replicates(film);
    ec_hash_rgb(p->planes.rgb, (uint64_t)p->planes.width * p->planes.height, job->image_sha256);
    ec_render_report report = ec_render_job_report(job, names);
    report.heavy_pixels = p->planes.heavy_count;
    report.clamp = ec_film_clamp_error(film);
    ec_render_report_attributes(&report, &p->attributes);
    ec_scene_free(job->scene);
    job->scene = NULL;
    return job->in_memory ? ec_render_job_tell(job, &report, err) : EC_OK;
}

static void take_merged(eclat_picture *p)
{
    const ec_merged *m = &p->call.merged;
    ec_merged_attributes(m, &p->attributes);
    p->error = m->error;
    p->samples_per_pixel = (double)m->samples_per_pixel;
    p->replicates = ec_film_replicates(&m->slices.all.film);
}

static void take_mix(eclat_picture *p)
{
    const ec_mix *m = &p->call.mix;
    const uint64_t pixels = (uint64_t)m->picture.width * m->picture.height;
    ec_mix_attributes(m, &p->attributes);
    p->error = (ec_film_error){.mean_luminance = m->mean_luminance, .error = m->error, .error_bound = INFINITY};
    for (uint64_t i = 0; i < pixels; i++) p->samples_per_pixel += (double)m->picture.constants[2 * i];
    p->samples_per_pixel /= (double)pixels;
    p->replicates = (uint32_t)m->replicates;
    snprintf(p->why, sizeof p->why, "%s", EC_MIX_WHY);
}

ec_result ec_lib_picture_finish(eclat_picture *p, ec_error *err)
{
    const bool is_mix = p->call.mix.picture.rgb != NULL;
    if (is_mix) take_mix(p);
    else if (p->call.merged.picture.rgb) take_merged(p);
    else EC_TRY(take_render(p, err));
    ec_picture_channels(planes_of(p), &p->channels);
    if (!is_mix) ec_error_why(&p->error, p->why, sizeof p->why);
    p->call.listener = p->call.render.listener = NULL; /* it is valid only during the run */
    return EC_OK;
}

void eclat_picture_free(eclat_picture *p)
{
    if (!p) return;
    ec_picture_free(&p->planes);
    ec_call_free(&p->call);
    free(p->line);
    free(p);
}

uint32_t eclat_picture_width(const eclat_picture *p) { return planes_of(p)->width; }
uint32_t eclat_picture_height(const eclat_picture *p) { return planes_of(p)->height; }

eclat_picture_error eclat_picture_get_error(const eclat_picture *p)
{
    const ec_film_error *e = &p->error;
    return (eclat_picture_error){.error = e->error, .error_bound = e->error_bound, .why = isfinite(e->error_bound) ? NULL : *p->why ? p->why : "the error is not known",
                                 .mean_luminance = e->mean_luminance, .samples_per_pixel = p->samples_per_pixel, .replicates = p->replicates};
}

static eclat_stated_error stated(const ec_stated_error *e) { return (eclat_stated_error){e->error, e->low95, e->high95}; }

eclat_denoised eclat_picture_get_denoised(const eclat_picture *p)
{
    const ec_denoised *d = !p->planes.rgb ? ec_merged_denoised(&p->call.merged) : p->call.render.request->options.denoise ? &p->call.render.denoised : NULL;
    const eclat_stated_error unknown = {INFINITY, INFINITY, INFINITY};
    if (!d || d->why_not) return (eclat_denoised){.denoised = unknown, .best = unknown, .why = d ? d->why_not : "the option denoise was not set"};
    return (eclat_denoised){.denoised = stated(&d->clean), .best = stated(&d->best), .bias = d->bias, .noise = d->noise, .tiles = d->tiles,
                            .tiles_nearer = d->nearer, .tiles_off = d->off};
}

size_t eclat_picture_channel_count(const eclat_picture *p) { return p->channels.count; }

eclat_channel eclat_picture_channel_at(const eclat_picture *p, size_t i)
{
    if (i >= p->channels.count) return (eclat_channel){0};
    const ec_channel *c = &p->channels.list[i];
    return (eclat_channel){c->name, c->data, c->stride};
}

eclat_channel eclat_picture_channel(const eclat_picture *p, const char *name)
{
    for (size_t i = 0; i < p->channels.count; i++)
        if (!strcmp(p->channels.list[i].name, name)) return eclat_picture_channel_at(p, i);
    return (eclat_channel){0};
}

size_t eclat_picture_attribute_count(const eclat_picture *p) { return p->attributes.count; }

eclat_attribute eclat_picture_attribute_at(const eclat_picture *p, size_t i)
{
    if (i >= p->attributes.count) return (eclat_attribute){0};
    const ec_attribute *a = &p->attributes.list[i];
    return (eclat_attribute){a->name, a->type == EC_ATTR_STRING ? a->string : NULL, a->number};
}

eclat_attribute eclat_picture_attribute(const eclat_picture *p, const char *name)
{
    for (size_t i = 0; i < p->attributes.count; i++)
        if (!strcmp(p->attributes.list[i].name, name)) return eclat_picture_attribute_at(p, i);
    return (eclat_attribute){0};
}

eclat_result eclat_picture_write(const eclat_picture *p, const char *path, eclat_error *err)
{
    ec_error why = {0};
    ec_outputs outputs = {0};
    ec_result result = ec_outputs_add(&outputs, path ? path : "", &why);
    if (result == EC_OK) result = p->call.write((ec_call *)(uintptr_t)&p->call, &outputs, &why);
    return ec_lib_end(result, &why, err);
}
