#include "report/effects_report.h"

#include <string.h>

#include "report/format.h"

void ec_effects_json(cJSON *root, const ec_render_effects *effects)
{
    char text[EC_EFFECT_NAMES];
    ec_feature_names(effects->built, text, sizeof text);
    ec_json_words(root, "effects", text, ' ');
    cJSON *list = cJSON_AddArrayToObject(root, "effect_list");
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        ec_effect_row row = ec_effect_describe(effects, i);
        cJSON *object = ec_json_object(list, NULL);
        EC_JSON(object, EC_STRING("name", row.name), EC_FLAG("called_for", row.called), EC_FLAG("left_out", row.left_out),
                EC_STRING("why", row.called ? row.why : NULL));
        ec_json_words(object, "kernels", row.kernels, ',');
        ec_json_words(object, "buffers", row.buffers, ',');
        ec_json_whole(object, "buffer_bytes", row.bytes);
    }
    ec_effects_kernels(effects, text, sizeof text);
    ec_json_words(root, "kernels", text, ',');
}

void ec_effects_line(const ec_render_effects *effects, char *text, size_t size)
{
    char names[EC_EFFECT_NAMES];
    uint32_t built = 0;
    for (uint32_t i = 0; i < ec_feature_count; i++) built += (effects->built & ec_features[i].bit) != 0;
    ec_feature_names(effects->built, names, sizeof names);
    snprintf(text, size, "%u of %u%s%s", built, ec_feature_count, built ? ": " : "", names);
}

void ec_effect_made(const ec_effect_row *row, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    if (*row->kernels) used = (size_t)snprintf(text, size, "; in %s", row->kernels);
    if (*row->buffers && used < size) snprintf(text + used, size - used, "; %s, %s", row->buffers, ec_bytes(row->bytes).text);
}

static void print_row(const ec_effect_row *row, FILE *to)
{
    char made[EC_EFFECT_MADE];
    ec_effect_made(row, made, sizeof made);
    const char *why = row->left_out ? "left out: --without" : "nothing calls for it: --effects all", *part = "";
    if (row->called) why = row->why, part = row->left_out ? "left out, but for: " : "";
    fprintf(to, "  %-26s %s%s%s\n", row->name, part, why, made);
}

void ec_effects_text(const ec_render_effects *effects, FILE *to, int width)
{
    char kernels[256];
    size_t column = 12;
    ec_effects_kernels(effects, kernels, sizeof kernels);
    fprintf(to, "%-*s%s\n%-*swhat calls for each, the kernels it is built into, its buffers\n", width, "kernels",
            kernels, width, "effects");
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        ec_effect_row row = ec_effect_describe(effects, i);
        if (row.built || row.left_out) print_row(&row, to);
    }
    fputs("  not built:", to);
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        if ((effects->built | effects->without) & ec_features[i].bit) continue;
        if (column + strlen(ec_features[i].name) > 118) column = (size_t)fprintf(to, "\n            ") - 1;
        column += (size_t)fprintf(to, " %s", ec_features[i].name);
    }
    fputc('\n', to);
}
