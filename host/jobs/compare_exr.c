/* Reads an EXR to compare, with its noise. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "film/channels.h"
#include "image/exr_header.h"
#include "image/image.h"
#include "jobs/compare_input.h"

/* Names of the first three channels of a plane. */
typedef struct names {
    const char *of[3];
} names;

static names names_of(ec_plane plane)
{
    names n;
    for (uint32_t c = 0; c < 3; c++) n.of[c] = ec_channel_name_of(plane, c);
    return n;
}

static ec_result missing(const char *path, const ec_exr *exr, const char *name, ec_error *err)
{
    char list[160] = "";
    for (uint32_t i = 0; i < exr->channel_count && strlen(list) < sizeof list - 40; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%.*s", i ? ", " : "", EC_CUT(exr->names[i], 32));
    }
    return ec_fail(err, "cannot compare '%s': it has no channel '%s' (but %s); %s", path, name, list,
                   strncmp(name, "stderr.", 7) ? "save it with R, G and B" : "render it with --channels stderr");
}

/* Interleaves `count` planes into *out, `count` floats per pixel. Fails if a value is not finite. */
static ec_result weave(const char *path, const ec_exr *exr, const char *const *names, uint32_t count, float **out, ec_error *err)
{
    uint64_t pixels = (uint64_t)exr->width * exr->height, broken = 0, first = 0;
    *out = malloc(pixels * count * sizeof **out);
    if (!*out) return ec_fail(err, "cannot compare '%s': %u x %u pixels do not fit into memory", path, exr->width, exr->height);
    for (uint32_t c = 0; c < count; c++) {
        const float *plane = ec_exr_plane(exr, names[c]);
        if (!plane) return missing(path, exr, names[c], err);
        for (uint64_t p = 0; p < pixels; p++) {
            (*out)[p * count + c] = plane[p];
            if (isfinite(plane[p])) continue;
            if (broken++ == 0 || p < first) first = p;
        }
    }
    if (!broken) return EC_OK;
    return ec_fail(err, "cannot compare '%s': %llu of its values %s NaN or infinite, the first in pixel (%llu, %llu); render it again or "
                   "repair the pixels", path, (unsigned long long)broken, broken == 1 ? "is" : "are",
                   (unsigned long long)(first % exr->width), (unsigned long long)(first / exr->width));
}

static double mean_of(const float *plane, uint64_t count)
{
    double sum = 0;
    for (uint64_t i = 0; i < count; i++) sum += plane[i];
    return sum / (double)count;
}

/* Returns the replicates that the file states; INFINITY if it does not. With 1, its standard errors are meaningless. */
static double count_replicates(const char *path)
{
    double replicates;
    return ec_exr_number(path, "eclat.replicates", &replicates) ? replicates : INFINITY;
}

static ec_result take_noise(const ec_exr *exr, ec_compare_input *input, ec_error *err)
{
    const char *path = input->path, *luminance = ec_channel_name_of(EC_PLANE_STDERR_Y, 0);
    const names error = names_of(EC_PLANE_STDERR);
    ec_measured *m = &input->measured;
    const float *samples = ec_exr_plane(exr, ec_channel_name_of(EC_PLANE_SAMPLES, 0));
    if (samples) m->samples = mean_of(samples, (uint64_t)exr->width * exr->height);
    m->replicates = count_replicates(path);
    if (m->replicates < 2 || !(ec_exr_plane(exr, error.of[0]) || ec_exr_plane(exr, error.of[1]) || ec_exr_plane(exr, error.of[2])))
        return EC_OK;
    EC_TRY(weave(path, exr, error.of, 3, &input->se, err));
    if (ec_exr_plane(exr, luminance)) EC_TRY(weave(path, exr, &luminance, 1, &input->se_y, err));
    m->se = input->se;
    m->se_y = input->se_y;
    return EC_OK;
}

ec_result ec_compare_read_exr(const char *path, ec_compare_input *input, ec_error *err)
{
    ec_exr exr;
    ec_result result;
    input->path = path;
    const names colour = names_of(EC_PLANE_RGB), error = names_of(EC_PLANE_STDERR);
    const char *const wanted[] = {colour.of[0], colour.of[1], colour.of[2], error.of[0], error.of[1], error.of[2],
                                  ec_channel_name_of(EC_PLANE_STDERR_Y, 0), ec_channel_name_of(EC_PLANE_SAMPLES, 0), NULL};
    EC_TRY(ec_exr_read_some(path, wanted, &exr, err));
    EC_TRY_CLEANUP(weave(path, &exr, colour.of, 3, &input->rgb, err));
    input->measured = (ec_measured){.width = exr.width, .height = exr.height, .rgb = input->rgb};
    for (int c = 0; c < 3; c++) input->measured.is_half |= ec_exr_is_half(path, colour.of[c]);
    EC_TRY_CLEANUP(take_noise(&exr, input, err));
    input->why = ec_exr_header_text(path, "eclat.errorBoundWhy");
cleanup:
    ec_exr_free(&exr);
    return result;
}
