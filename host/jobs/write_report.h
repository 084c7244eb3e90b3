/* Writes a film with its report to the files that were asked for. */
#ifndef EC_JOBS_WRITE_REPORT_H
#define EC_JOBS_WRITE_REPORT_H

#include "jobs/hash.h"
#include "jobs/outputs.h"
#include "jobs/write_rows.h"
#include "film/film.h"
#include "report/render_report.h"
#include "store/store.h"

/* The data that make a picture a part of a job, which `eclat merge` can add to others. */
typedef struct ec_slice {
    const ec_job *job;
    const ec_past *past;
} ec_slice;

/* Write rows as they come: open with the first ones in `film` and what is known by then, put the others, and close with what has become known
 * meanwhile. outputs and report must live as long. */
ec_result ec_report_rows_open(ec_row_writer **writer, ec_outputs *outputs, ec_channel_set channels, const ec_film *film, uint32_t height,
                              ec_render_report *report, uint32_t room, ec_error *err);
ec_result ec_report_rows_close(ec_row_writer *writer, ec_render_report *report, const ec_rows_told *told, ec_error *err);

/* Counts the report's heavy pixels, hashes the picture into sha256 (to which the report may point already), and writes. slice may be NULL. */
ec_result ec_write_report(ec_outputs *outputs, ec_channel_set channels, const ec_film *film, const ec_slice *slice, ec_render_report *report,
                          char sha256[EC_HASH_SIZE], ec_error *err);

#endif
