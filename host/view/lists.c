#include "view/lists.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/block.h"
#include "view/keys.h"

#define LEAST 9      /* pixels: smaller text is illegible */
#define LINE 1.15    /* distance of rows over the height of text */

static const float white[3] = {1, 1, 1}, grey[3] = {0.6f, 0.65f, 0.7f};

static size_t widest_key(void)
{
    size_t most = 0;
    for (size_t i = 0; i < ec_view_key_count; i++)
        most = strlen(ec_view_keys[i].shown) > most ? strlen(ec_view_keys[i].shown) : most;
    return most;
}

double ec_view_help_size(double most, double width, double height)
{
    size_t columns = 0;
    for (size_t i = 0; i < ec_view_key_count; i++)
        columns = strlen(ec_view_keys[i].help) > columns ? strlen(ec_view_keys[i].help) : columns;
    double across = width / ((double)(columns + widest_key() + 4) * EC_TEXT_NARROW),
           down = height / ((double)(ec_view_key_count + 1) * LINE + 1);
    return fmax(floor(fmin(most, fmin(across, down))), fmin(LEAST, most));
}

void ec_view_help_draw(const ec_view_text *text, double width, double height)
{
    char line[160];
    int keys = (int)widest_key();
    bool fits = true;
    ec_view_block b;
    ec_block_start(&b, text, width, height);
    if (b.columns < 60) keys = 0; /* too narrow for a table */
    for (size_t i = 0; i < ec_view_key_count && fits; i++) {
        snprintf(line, sizeof line, "%-*s  %s", keys, ec_view_keys[i].shown, ec_view_keys[i].help);
        fits = ec_block_add(&b, line, (size_t)keys + 2, white);
    }
    if (!fits && b.count) snprintf(b.row[b.count - 1].line, sizeof b.row[0].line, "... eclat view --help");
    ec_block_draw(&b, 0, height, width);
}

static uint32_t pages_of(const eclat_facts *facts)
{
    return facts->effect_count ? (facts->effect_count + 8) / 9 : 1;
}

const eclat_effect *ec_view_effect_of_digit(const eclat_facts *facts, uint32_t page, int digit)
{
    uint32_t index = page % pages_of(facts) * 9 + (uint32_t)digit - 1;
    return digit && index < facts->effect_count ? &facts->effects[index] : NULL;
}

void ec_view_effects_draw(const eclat_facts *facts, uint32_t page, uint64_t without, const ec_view_text *text, double width, double height)
{
    char line[320];
    ec_view_block b;
    ec_block_start(&b, text, width, height);
    ec_block_add(&b, "effects: a digit switches one off or on, X closes", 2, white);
    if (!facts->effect_count) ec_block_add(&b, "the scene calls for none that can be left out", 2, grey);
    for (int digit = 1; digit <= 9; digit++) {
        const eclat_effect *effect = ec_view_effect_of_digit(facts, page, digit);
        if (!effect) break;
        snprintf(line, sizeof line, "%d  %-3s  %s", digit, without & effect->bit ? "off" : "on", effect->name);
        ec_block_add(&b, line, 8, without & effect->bit ? grey : white);
    }
    if (pages_of(facts) > 1) {
        snprintf(line, sizeof line, "0       more (%u of %u)", page % pages_of(facts) + 1, pages_of(facts));
        ec_block_add(&b, line, 8, grey);
    }
    ec_block_draw(&b, 0, height, fmin(ec_block_width(&b), width));
}
