#include "jobs/write_report.h"

#include <stdio.h>
#include <string.h>

#include "jobs/frame_job.h"

static ec_screen screen_of(const ec_render_report *report)
{
    return (ec_screen){.exposure = (float)report->exposure, .tonemap = report->tonemap, .background = report->background, .behind = report->behind, .ocio = report->ocio};
}

/* Writes the whole picture with its sums. */
static ec_result write_slice(ec_outputs *outputs, const ec_film *film, const ec_slice *slice, ec_render_report *report,
                             char sha256[EC_HASH_SIZE], ec_error *err)
{
    ec_picture picture = {0};
    ec_report_attributes attributes;
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_picture_resolve(film, true, &picture, err));
    report->heavy_pixels = picture.heavy_count;
    report->clamp = ec_film_clamp_error(film);
    ec_hash_rgb(picture.rgb, (uint64_t)picture.width * picture.height, sha256);
    report->image_sha256 = sha256;
    ec_render_report_attributes(report, &attributes);
    const ec_picture_style style = {.screen = screen_of(report),
                                    .deep = report->is_png_deep,
                                    .attributes = attributes.list,
                                    .attribute_count = attributes.count,
                                    .job = slice->job,
                                    .film = film,
                                    .past = slice->past};
    EC_TRY_CLEANUP(ec_outputs_write(outputs, &picture, &style, err));
cleanup:
    ec_picture_free(&picture);
    return result;
}

ec_result ec_report_rows_open(ec_row_writer **writer, ec_outputs *outputs, ec_channel_set channels, const ec_film *film, uint32_t height,
                              ec_render_report *report, uint32_t room, ec_error *err)
{
    char no_hash[EC_HASH_SIZE] = "";
    ec_report_attributes attributes;
    memset(no_hash, '0', EC_HASH_SIZE - 1); /* a placeholder as long as the hash that will be known */
    report->image_sha256 = no_hash;
    ec_render_report_attributes(report, &attributes);
    const ec_picture_style style = {.screen = screen_of(report),
                                    .deep = report->is_png_deep,
                                    .channels = channels,
                                    .attributes = attributes.list,
                                    .attribute_count = attributes.count,
                                    .text = {EC_FRAME_ATTRIBUTE, report->frame ? report->frame->job : NULL},
                                    .is_sealed = report->frame != NULL};
    const ec_error_sums *sums = &report->stats->sums;
    ec_result result = ec_row_writer_open(writer, outputs, film, sums->samples > 0 && film->height == height ? sums : NULL, height, &style, room, err);
    report->image_sha256 = "";
    return result;
}

ec_result ec_report_rows_close(ec_row_writer *writer, ec_render_report *report, const ec_rows_told *told, ec_error *err)
{
    ec_report_attributes attributes;
    report->heavy_pixels = told->heavy;
    report->clamp = told->clamp;
    report->image_sha256 = told->sha256;
    ec_render_report_attributes(report, &attributes);
    return ec_row_writer_close(writer, attributes.list, attributes.count, err);
}

ec_result ec_write_report(ec_outputs *outputs, ec_channel_set channels, const ec_film *film, const ec_slice *slice, ec_render_report *report,
                          char sha256[EC_HASH_SIZE], ec_error *err)
{
    ec_row_writer *writer;
    ec_rows_told told;
    if (slice) return write_slice(outputs, film, slice, report, sha256, err);
    EC_TRY(ec_report_rows_open(&writer, outputs, channels, film, film->height, report, 0, err));
    ec_result result = ec_row_writer_finish(writer, &told, err);
    if (result != EC_OK) {
        ec_row_writer_abort(writer);
        return result;
    }
    result = ec_report_rows_close(writer, report, &told, err);
    snprintf(sha256, EC_HASH_SIZE, "%s", told.sha256);
    report->image_sha256 = sha256;
    return result;
}
