#include "jobs/merge_job.h"

#include <stdlib.h>
#include <string.h>

#include "jobs/denoise_choice.h"
#include "report/denoise_report.h"
#include "report/error_text.h"

static ec_result take_slices(char **paths, int count, bool is_partial, ec_merge *merge, const ec_log *log, ec_error *err)
{
    char missing[512];
    EC_TRY(ec_merge_sort(paths, count, err));
    for (int i = 0; i < count; i++) EC_TRY(ec_merge_take(merge, paths[i], log, err));
    if (!ec_merge_missing(merge, missing, sizeof missing)) return EC_OK;
    if (!is_partial) return ec_fail(err, "samples %s are missing; render them with --samples, or write what there is with --partial", missing);
    ec_warn(log, "samples %s are missing; the picture is made of the others", missing);
    return EC_OK;
}

double ec_merged_clamp(const ec_merged *m)
{
    const char *value = ec_identity_value(&m->slices.all.job.identity, "--clamp");
    return m->slices.all.film.limit > 0 && value ? strtod(value, NULL) : 0;
}

void ec_merged_attributes(const ec_merged *m, ec_report_attributes *to)
{
    const ec_film *film = &m->slices.all.film;
    EC_ATTRIBUTES(to, EC_STRING("eclat.command", m->command), EC_STRING("eclat.version", ECLAT_VERSION),
                  EC_WHOLE("eclat.replicates", ec_film_replicates(film)), EC_WHOLE("eclat.samplesPerPixel", m->samples_per_pixel),
                  EC_REAL("eclat.error", m->error.error));
    if (m->error.is_open) EC_ATTRIBUTES(to, EC_STRING("eclat.errorBoundWhy", m->why));
    else EC_ATTRIBUTES(to, EC_REAL("eclat.errorBound", m->error.error_bound));
    EC_ATTRIBUTES(to, EC_REAL("eclat.relMSE", m->error.relmse), EC_STRING("eclat.device", m->slices.all.job.device),
                  EC_STRING("eclat.imageSha256", m->sha256));
    ec_denoised_attributes(to, ec_merged_denoised(m));
    if (film->limit > 0) ec_clamp_attributes(to, ec_merged_clamp(m), (double)film->limit, &m->clamp);
}

double ec_merged_stops(const ec_merged *m, const ec_exposure *exposure) { return ec_exposure_stops(exposure, &m->slices.all.film); }

ec_result ec_merged_write(const ec_merged *m, ec_outputs *outputs, const ec_exposure *exposure, ec_tonemap tonemap, ec_error *err)
{
    ec_report_attributes attributes = {.count = 0};
    ec_merged_attributes(m, &attributes);
    const ec_picture_style style = {.screen = {.exposure = (float)ec_merged_stops(m, exposure), .tonemap = tonemap},
                                    .attributes = attributes.list,
                                    .attribute_count = attributes.count,
                                    .job = &m->slices.all.job,
                                    .film = &m->slices.all.film,
                                    .past = &m->slices.all.past};
    return ec_outputs_write(outputs, &m->picture, &style, err);
}

const ec_denoised *ec_merged_denoised(const ec_merged *m) { return m->denoiser ? &m->denoised : NULL; }

/* Denoises by the library, which runs on the processor, or by eclat's own filter, which needs a device; a merge has no other use for one. */
static ec_result denoise(ec_merged *m, ec_denoiser found, ec_error *err)
{
    ec_device_info device = {0};
    uint32_t index;
    const char *why;
    if (!found) return EC_OK;
    if (found == EC_DENOISER_ATROUS) EC_TRY(ec_device_find(NULL, &device, &index, &why, err));
    return ec_denoise(&m->slices.all.film, found, &device, &m->denoised, err);
}

ec_result ec_merged_make(char **paths, int count, bool is_partial, ec_denoiser denoiser, const char *command, ec_merged *m, const ec_log *log,
                         ec_error *err)
{
    const ec_film *film = &m->slices.all.film;
    ec_denoiser found;
    *m = (ec_merged){.command = command, .denoiser = denoiser};
    EC_TRY(ec_require_denoiser(denoiser, &found, log, err));
    EC_TRY(take_slices(paths, count, is_partial, &m->slices, log, err));
    m->error = ec_film_estimate_error(film);
    m->clamp = ec_film_clamp_error(film);
    ec_error_why(&m->error, m->why, sizeof m->why);
    m->samples_per_pixel = m->slices.all.past.samples / ((uint64_t)film->width * film->height);
    EC_TRY(denoise(m, found, err));
    EC_TRY(ec_picture_resolve(film, true, &m->picture, err));
    ec_hash_rgb(m->picture.rgb, (uint64_t)m->picture.width * m->picture.height, m->sha256);
    return EC_OK;
}

void ec_merged_free(ec_merged *m)
{
    ec_picture_free(&m->picture);
    ec_merge_free(&m->slices);
}
