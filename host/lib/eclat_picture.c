#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lib/internal.h"
#include "report/error_text.h"

static const ec_picture *planes_of(const eclat_picture *p) { return p->planes.rgb ? &p->planes : &p->merged.picture; }

ec_result ec_lib_picture_finish(eclat_picture *p, ec_error *err)
{
    const char *names[EC_OUTPUTS_MAX];
    if (!p->merged.picture.rgb) {
        const ec_film *film = &p->job.film;
        EC_TRY(ec_picture_resolve(film, true, &p->planes, err));
        p->error = p->job.stats.film = ec_film_estimate_error(film);
        p->samples_per_pixel = (double)p->job.stats.samples / ((double)film->width * film->height);
        p->replicates = ec_film_replicates(film);
        ec_hash_rgb(p->planes.rgb, (uint64_t)p->planes.width * p->planes.height, p->job.image_sha256);
        ec_render_report report = ec_render_job_report(&p->job, names);
        report.heavy_pixels = p->planes.heavy_count;
        report.clamp = ec_film_clamp_error(film);
        ec_render_report_attributes(&report, &p->attributes);
        ec_scene_free(p->job.scene);
        p->job.scene = NULL;
    }
    ec_picture_channels(planes_of(p), &p->channels);
    ec_error_why(&p->error, p->why, sizeof p->why);
    return EC_OK;
}

void eclat_picture_free(eclat_picture *p)
{
    if (!p) return;
    ec_picture_free(&p->planes);
    ec_merged_free(&p->merged);
    ec_render_job_free(&p->job);
    eclat_job_free(p->options);
    while (p->word_count) free(p->words[--p->word_count]);
    free(p->words);
    free(p->command);
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
    if (result == EC_OK) result = p->write((eclat_picture *)(uintptr_t)p, &outputs, &why);
    return ec_lib_end(result, &why, err);
}
