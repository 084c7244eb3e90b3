#include "cli/write_report.h"

#include "cli/write_outputs.h"

ec_result ec_write_report(ec_outputs *outputs, const ec_film *film, const ec_slice *slice, ec_render_report *report, char sha256[EC_HASH_SIZE], ec_error *err)
{
    ec_picture picture = {0};
    ec_report_attributes attributes;
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_picture_resolve(film, true, &picture, err));
    report->heavy_pixels = picture.heavy_count;
    ec_hash_rgb(picture.rgb, (uint64_t)picture.width * picture.height, sha256);
    report->image_sha256 = sha256;
    ec_render_report_attributes(report, &attributes);
    ec_picture_style style = {.exposure = (float)report->exposure,
                              .tonemap = report->tonemap,
                              .attributes = attributes.list,
                              .attribute_count = attributes.count,
                              .frame_job = report->frame ? report->frame->job : NULL};
    if (slice) style.job = slice->job, style.film = film, style.past = slice->past;
    EC_TRY_CLEANUP(ec_outputs_write(outputs, &picture, &style, err));
cleanup:
    ec_picture_free(&picture);
    return result;
}
