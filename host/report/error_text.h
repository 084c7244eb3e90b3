/* Describes an image's error in words and in JSON, for renders and merged pictures alike. */
#ifndef EC_REPORT_ERROR_TEXT_H
#define EC_REPORT_ERROR_TEXT_H

#include "film/clamp.h"
#include "report/attributes.h"

enum { EC_ERROR_TEXT = 512 };

/* Writes "error 1.93 % (95 % bound 1.97 %)", or "error at least 9.8 %: no bound, since …". */
void ec_error_text(const ec_film_error *error, char *text, size_t size);

/* Writes why there is no bound, without a full stop; empty if there is one. */
void ec_error_why(const ec_film_error *error, char *text, size_t size);

/* Returns what the picture is good for, by its bound and the clamp's bias, on the scale of the manual. clamp: NULL without one. */
const char *ec_error_grade(const ec_film_error *error, const ec_clamp_error *clamp);

/* Writes what would give a bound; empty if there is one. */
void ec_error_help(const ec_film_error *error, char *text, size_t size);

/* Adds error_bound_why, null if there is a bound, and the figures behind it. */
void ec_error_json(cJSON *root, const ec_film_error *error, const ec_clamp_error *clamp);

/* Describes a clamp: "3.1 % of the light is missing (standard error 0.2 %); noise 1.2 %, bias 4.0 %, together 4.2 %"; "bias up to 4.0 %" if noise
 * dominates. is_open: more may be missing (film/rare.h). */
void ec_clamp_text(const ec_clamp_error *clamp, bool is_open, char *text, size_t size);

/* limit: the option's value, in mean luminances; luminance: the limit itself. */
void ec_clamp_json(cJSON *root, double limit, double luminance, const ec_clamp_error *clamp);
void ec_clamp_attributes(ec_report_attributes *attributes, double limit, double luminance, const ec_clamp_error *clamp);

#endif
