/* Words for choices, shared by options and reports. Each list is in the order of its enum and ended by NULL. */
#ifndef EC_REPORT_NAMES_H
#define EC_REPORT_NAMES_H

#include "image/screen.h"

extern const char *const ec_compile_names[];    /* ec_compile */
extern const char *const ec_begun_names[];      /* ec_begun */
extern const char *const ec_instancing_names[]; /* ec_instancing */
extern const char *const ec_filter_names[];     /* ec_pixel_filter */
extern const char *const ec_light_choice_names[]; /* ec_light_choice */
extern const char *const ec_integrator_names[]; /* ec_integrator */
extern const char *const ec_sample_names[];     /* ec_sample */
extern const char *const ec_sampler_names[];    /* ec_sampler_type */
extern const char *const ec_scattering_names[]; /* ec_scattering */
extern const char *const ec_terminator_names[]; /* ec_terminator */
extern const char *const ec_tonemap_names[];    /* ec_tonemap */

/* Returns "env", "transparent" or "#3366cc". */
typedef struct ec_background_text {
    char text[24];
} ec_background_text;
ec_background_text ec_background_name(const ec_background *background);

#endif
