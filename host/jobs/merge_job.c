#include "jobs/merge_job.h"

#include <stdlib.h>
#include <string.h>

#include "report/error_text.h"

static ec_result take_slices(char **paths, int count, bool is_partial, ec_merge *merge, const ec_log *log, ec_error *err)
{
    char missing[512];
    EC_TRY(ec_merge_sort(paths, count, err));
    for (int i = 0; i < count; i++) EC_TRY(ec_merge_take(merge, paths[i], log, err));
    if (!ec_merge_missing(merge, missing, sizeof missing)) return EC_OK;
    if (!is_partial) return ec_fail(err, "samples %s are missing; render them with --samples, or write what there is with --partial", missing);
    ec_warn(log, "samples %s are missing: the picture is of the others", missing);
    return EC_OK;
}

/* --clamp, as the slices had it; 0: they had none. */
double ec_merged_clamp(const ec_merged *m)
{
    const char *value = ec_identity_value(&m->slices.all.job.identity, "--clamp");
    return m->slices.all.film.limit > 0 && value ? strtod(value, NULL) : 0;
}

uint32_t ec_merged_attributes(const ec_merged *m, ec_attribute list[EC_MERGED_ATTRIBUTES])
{
    const ec_film *film = &m->slices.all.film;
    const ec_attribute attributes[EC_MERGED_ATTRIBUTES] = {
        {.name = "eclat.command", .type = EC_ATTR_STRING, .string = m->command},
        {.name = "eclat.version", .type = EC_ATTR_STRING, .string = ECLAT_VERSION},
        {.name = "eclat.replicates", .type = EC_ATTR_INT, .number = ec_film_replicates(film)},
        {.name = "eclat.samplesPerPixel", .type = EC_ATTR_INT, .number = (double)m->samples_per_pixel},
        {.name = "eclat.error", .type = EC_ATTR_DOUBLE, .number = m->error.error},
        m->error.is_open ? (ec_attribute){.name = "eclat.errorBoundWhy", .type = EC_ATTR_STRING, .string = m->why}
                         : (ec_attribute){.name = "eclat.errorBound", .type = EC_ATTR_DOUBLE, .number = m->error.error_bound},
        {.name = "eclat.relMSE", .type = EC_ATTR_DOUBLE, .number = m->error.relmse},
        {.name = "eclat.device", .type = EC_ATTR_STRING, .string = m->slices.all.job.device},
        {.name = "eclat.imageSha256", .type = EC_ATTR_STRING, .string = m->sha256},
        {.name = "eclat.clamp.limit", .type = EC_ATTR_DOUBLE, .number = ec_merged_clamp(m)}, /* from here on without a clamp left out */
        {.name = "eclat.clamp.luminance", .type = EC_ATTR_DOUBLE, .number = (double)film->limit},
        {.name = "eclat.clamp.missing", .type = EC_ATTR_DOUBLE, .number = m->clamp.missing},
        {.name = "eclat.clamp.missingStderr", .type = EC_ATTR_DOUBLE, .number = m->clamp.missing_stderr},
        {.name = "eclat.clamp.noise", .type = EC_ATTR_DOUBLE, .number = m->clamp.noise},
        {.name = "eclat.clamp.bias", .type = EC_ATTR_DOUBLE, .number = m->clamp.bias},
        {.name = "eclat.clamp.error", .type = EC_ATTR_DOUBLE, .number = m->clamp.error},
    };
    enum { OF_CLAMP = 7 };
    memcpy(list, attributes, sizeof attributes);
    return EC_MERGED_ATTRIBUTES - (film->limit > 0 ? 0 : OF_CLAMP);
}

ec_result ec_merged_write(const ec_merged *m, ec_outputs *outputs, double exposure, ec_tonemap tonemap, ec_error *err)
{
    ec_attribute attributes[EC_MERGED_ATTRIBUTES];
    const ec_picture_style style = {.exposure = (float)exposure,
                                    .tonemap = tonemap,
                                    .attributes = attributes,
                                    .attribute_count = ec_merged_attributes(m, attributes),
                                    .job = &m->slices.all.job,
                                    .film = &m->slices.all.film,
                                    .past = &m->slices.all.past};
    return ec_outputs_write(outputs, &m->picture, &style, err);
}

ec_result ec_merged_make(char **paths, int count, bool is_partial, const char *command, ec_merged *m, const ec_log *log, ec_error *err)
{
    const ec_film *film = &m->slices.all.film;
    *m = (ec_merged){.command = command};
    EC_TRY(take_slices(paths, count, is_partial, &m->slices, log, err));
    m->error = ec_film_estimate_error(film);
    m->clamp = ec_film_clamp_error(film);
    ec_error_why(&m->error, m->why, sizeof m->why);
    m->samples_per_pixel = m->slices.all.past.samples / ((uint64_t)film->width * film->height);
    EC_TRY(ec_picture_resolve(film, true, &m->picture, err));
    ec_hash_rgb(m->picture.rgb, (uint64_t)m->picture.width * m->picture.height, m->sha256);
    return EC_OK;
}

void ec_merged_free(ec_merged *m)
{
    ec_picture_free(&m->picture);
    ec_merge_free(&m->slices);
}
