/* Writes the page of eclat compare --html, whose parts are embedded at build time from jobs/gallery/. */
#ifndef EC_JOBS_COMPARE_GALLERY_H
#define EC_JOBS_COMPARE_GALLERY_H

#include "jobs/compare_job.h"

extern const char ec_text_gallery_html[]; /* with placeholders @STYLE@, @TEXT@, @DATA@, @SCRIPT@ */
extern const char ec_text_gallery_css[];
extern const char ec_text_gallery_js[];

/* Appends a comparison that was measured to `pairs`: {"report": as --json, "a", "b", "error", "flip": pictures}. */
ec_result ec_gallery_add(cJSON *pairs, const ec_compare_job *job, ec_error *err);

/* Writes the page. text: the comparisons as text, for readers without JavaScript. */
ec_result ec_gallery_write(const char *path, const cJSON *pairs, const char *text, ec_error *err);

#endif
