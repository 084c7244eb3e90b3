/* Lists that open over the picture: help and effects. */
#ifndef EC_VIEW_LISTS_H
#define EC_VIEW_LISTS_H

#include <eclat/eclat.h>

#include "view/glyphs.h"

/* Returns the largest text size in pixels, at most `most`, with which all of the help fits. */
double ec_view_help_size(double most, double width, double height);
void ec_view_help_draw(const ec_view_text *text, double width, double height);

/* Draws nine effects at a time. page: any number, taken modulo. */
void ec_view_effects_draw(const eclat_facts *facts, uint32_t page, uint64_t without, const ec_view_text *text, double width, double height);

/* Returns the effect of a digit from 1 on; NULL: none. */
const eclat_effect *ec_view_effect_of_digit(const eclat_facts *facts, uint32_t page, int digit);

#endif
