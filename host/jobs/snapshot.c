#include "jobs/snapshot.h"

#include <string.h>

/* Attributes of a snapshot: the first ones of the final picture, as far as they are known. */
enum { ATTRIBUTES = 7 };

static uint32_t list(const ec_render_job *job, const ec_film_error *error, const ec_past *past, ec_attribute attributes[ATTRIBUTES])
{
    const double pixels = (double)job->request->options.width * job->request->options.height;
    const ec_attribute all[ATTRIBUTES] = {
        {.name = "eclat.command", .type = EC_ATTR_STRING, .string = job->command},
        {.name = "eclat.version", .type = EC_ATTR_STRING, .string = ECLAT_VERSION},
        {.name = "eclat.stoppedBy", .type = EC_ATTR_STRING, .string = "nothing yet"},
        {.name = "eclat.samplesPerPixel", .type = EC_ATTR_DOUBLE, .number = (double)past->samples / pixels},
        {.name = "eclat.seconds", .type = EC_ATTR_DOUBLE, .number = past->seconds},
        {.name = "eclat.error", .type = EC_ATTR_DOUBLE, .number = error->error},
        {.name = "eclat.errorBound", .type = EC_ATTR_DOUBLE, .number = error->error_bound},
    };
    memcpy(attributes, all, sizeof all);
    return error->is_open ? ATTRIBUTES - 1 : ATTRIBUTES;
}

ec_result ec_snapshot_write(ec_render_job *job, const ec_film *film, const ec_past *past, ec_error *err)
{
    const ec_render_request *request = job->request;
    ec_error_sums sums;
    ec_attribute attributes[ATTRIBUTES];
    ec_outputs file = {.count = 0};
    ec_row_writer *writer;
    ec_rows_told told;
    if (film->batch_count == 0 || film->batch_count == job->shot_batches) return EC_OK;
    const ec_film_error error = ec_film_look_at_error(film, &sums);
    const ec_picture_style style = {.channels = ec_render_channels(request),
                                    .attributes = attributes,
                                    .attribute_count = list(job, &error, past, attributes)};
    EC_TRY(ec_outputs_add(&file, request->snapshot, err));
    EC_TRY(ec_row_writer_open(&writer, &file, film, &sums, film->height, &style, 0, err));
    const ec_result result = ec_row_writer_finish(writer, &told, err);
    if (result != EC_OK) {
        ec_row_writer_abort(writer);
        return result;
    }
    EC_TRY(ec_row_writer_close(writer, attributes, style.attribute_count, err));
    job->shot_batches = film->batch_count;
    return EC_OK;
}
