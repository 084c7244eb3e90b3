/* An image's error in words and in JSON, for renders and merged pictures alike. */
#ifndef EC_REPORT_ERROR_TEXT_H
#define EC_REPORT_ERROR_TEXT_H

#include "film/clamp.h"
#include "report/attributes.h"

enum { EC_ERROR_TEXT = 512 };

/* "error 1.93 % (95 % bound 1.97 %)", or "error at least 9.8 %: no bound, since …". */
void ec_error_text(const ec_film_error *error, char *text, size_t size);

/* Why there is no bound, without a full stop; empty where there is one. */
void ec_error_why(const ec_film_error *error, char *text, size_t size);

/* Names what the picture is good for, by its bound and the clamp's bias; the scale is the manual's. clamp: NULL without one. */
const char *ec_error_grade(const ec_film_error *error, const ec_clamp_error *clamp);

/* Names what would bring a bound; empty where there is one. */
void ec_error_help(const ec_film_error *error, char *text, size_t size);

/* error_bound_why, null where there is a bound, and the figures that it goes by. */
void ec_error_json(cJSON *root, const ec_film_error *error, const ec_clamp_error *clamp);

/* A clamp's: "3.1 % of the light is missing (standard error 0.2 %); noise 1.2 %, bias 4.0 %, together 4.2 %"; "bias up to 4.0 %" where noise decides.
 * is_open: more may be missing (film/rare.h). */
void ec_clamp_text(const ec_clamp_error *clamp, bool is_open, char *text, size_t size);

/* limit: as the option has it, in mean luminances; luminance: the limit itself. */
void ec_clamp_json(cJSON *root, double limit, double luminance, const ec_clamp_error *clamp);
void ec_clamp_attributes(ec_report_attributes *attributes, double limit, double luminance, const ec_clamp_error *clamp);

#endif
