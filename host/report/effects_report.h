/* Reports the effects of a scene: which are called for, why, and what is built, launched and allocated for them. */
#ifndef EC_REPORT_EFFECTS_REPORT_H
#define EC_REPORT_EFFECTS_REPORT_H

#include <stdio.h>

#include "device/effects.h"
#include "report/json.h"

/* Adds "effects", the names of those built in; "effect_list", an object for each effect that exists; and "kernels", those launched. */
void ec_effects_json(cJSON *root, const ec_render_effects *effects);
/* Prints a line for each effect that is built in, and the names of all others; titles take `width` columns. */
void ec_effects_text(const ec_render_effects *effects, FILE *to, int width);
/* Writes e.g. "; in shade; texels, 4 KB": the kernels that an effect is built into, and its buffers; empty if there are none. */
enum { EC_EFFECT_MADE = 384 };
void ec_effect_made(const ec_effect_row *row, char *text, size_t size);
/* Writes e.g. "4 of 30: emission area-lights culling sobol-sampler". */
void ec_effects_line(const ec_render_effects *effects, char *text, size_t size);

#endif
