#include "jobs/scenarios.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/image.h"
#include "jobs/option.h"

#define RADIANS (3.14159265358979323846 / 180)

typedef struct reading {
    const char *file, *folder;
    int base; /* length of the file's folder, including the slash */
    const ec_given_options *given;
    const cJSON *defaults;
} reading;

/* Returns a member of the scenario or, if it has none, of the defaults. */
static const cJSON *find(const reading *r, const cJSON *scenario, const char *key)
{
    const cJSON *own = cJSON_GetObjectItemCaseSensitive(scenario, key);
    return own ? own : cJSON_GetObjectItemCaseSensitive(r->defaults, key);
}

static const char *text_of(const reading *r, const cJSON *scenario, const char *key) { return cJSON_GetStringValue(find(r, scenario, key)); }

/* Reads "target": {"y": 1} or [0, 1, 0]. Numbers missing in the scenario come from the defaults, or else stay unchanged. */
static ec_result take_numbers(const reading *r, const cJSON *scenario, const char *key, const char *const *names, int count, double *values, ec_error *err)
{
    const cJSON *const in[] = {cJSON_GetObjectItemCaseSensitive(r->defaults, key), cJSON_GetObjectItemCaseSensitive(scenario, key)};
    for (int k = 0; k < 2; k++)
        for (int i = 0; in[k] && i < count; i++) {
            const cJSON *one = cJSON_IsArray(in[k]) ? cJSON_GetArrayItem(in[k], i) : cJSON_IsObject(in[k]) ? cJSON_GetObjectItemCaseSensitive(in[k], names[i]) : NULL;
            if (!one && cJSON_IsObject(in[k])) continue;
            if (!cJSON_IsNumber(one) || !isfinite(one->valuedouble)) return ec_fail(err, "\"%s\" has no number for %s", key, names[i]);
            values[i] = one->valuedouble;
        }
    return EC_OK;
}

/* Gives the entry an option, unless the command line has it. Invalid values are reported as for the command line. */
static __attribute__((format(printf, 5, 6))) ec_result give(const reading *r, ec_entry *entry, const char *option, ec_error *err, const char *format, ...)
{
    char value[PATH_MAX];
    va_list args;
    if (ec_given_has(r->given, option)) return EC_OK;
    va_start(args, format);
    const int size = vsnprintf(value, sizeof value, format, args);
    va_end(args);
    if (size >= (int)sizeof value) return ec_fail(err, "--%s: the path is longer than %d bytes", option, PATH_MAX - 1);
    ec_render_request *trial = malloc(sizeof *trial);
    if (!trial) return ec_fail(err, "out of memory");
    ec_render_request_start(trial);
    ec_result result = ec_option_store(ec_render_row(option), trial, value, err);
    free(trial);
    return result == EC_OK ? ec_given_add(&entry->given, option, value, err) : EC_FAILED;
}

static ec_result give_camera(const reading *r, const cJSON *scenario, ec_entry *entry, ec_error *err)
{
    static const char *const axes[] = {"x", "y", "z"}, *const angles[] = {"theta", "phi", "radius"};
    double target[3] = {0}, orbit[3] = {0, 90, 1}, eye[3], up[3] = {0, 1, 0}, m[16] = {0};
    const cJSON *matrix = find(r, scenario, "matrix");
    if (matrix) {
        if (cJSON_GetArraySize(matrix) != 16) return ec_fail(err, "\"matrix\" has %d numbers; 16 place a camera, column by column, as in glTF", cJSON_GetArraySize(matrix));
        for (int i = 0; i < 16; i++) m[i] = cJSON_GetNumberValue(cJSON_GetArrayItem(matrix, i));
        for (int k = 0; k < 3; k++) eye[k] = m[12 + k], target[k] = m[12 + k] - m[8 + k], up[k] = m[4 + k];
        EC_TRY(give(r, entry, "up", err, "%.9g,%.9g,%.9g", up[0], up[1], up[2]));
    } else {
        EC_TRY(take_numbers(r, scenario, "target", axes, 3, target, err));
        EC_TRY(take_numbers(r, scenario, "orbit", angles, 3, orbit, err));
        const double theta = orbit[0] * RADIANS, phi = orbit[1] * RADIANS, out[3] = {sin(phi) * sin(theta), cos(phi), sin(phi) * cos(theta)};
        for (int k = 0; k < 3; k++) eye[k] = target[k] + orbit[2] * out[k];
        for (int k = 0; k < 3 && !(orbit[2] > 0); k++) target[k] = eye[k] - out[k]; /* the camera is inside what it orbits, as in a room */
    }
    EC_TRY(give(r, entry, "eye", err, "%.9g,%.9g,%.9g", eye[0], eye[1], eye[2]));
    EC_TRY(give(r, entry, "look-at", err, "%.9g,%.9g,%.9g", target[0], target[1], target[2]));
    const cJSON *fov = find(r, scenario, "verticalFoV");
    return ec_given_has(r->given, "parallel") ? EC_OK : give(r, entry, "fov", err, "%.9g", fov ? cJSON_GetNumberValue(fov) : 45);
}

/* Translates tone curves that viewers know by other names. */
static const char *tone_curve(const char *name)
{
    static const char *const names[][2] = {{"commerce", "neutral"}, {"pbr-neutral", "neutral"}, {"linear", "none"}, {"ACESFilmic", "aces"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(name, names[i][0])) return names[i][1];
    return name;
}

static ec_result give_picture(const reading *r, const cJSON *scenario, ec_entry *entry, ec_error *err)
{
    static const char *const sides[] = {"width", "height"};
    const char *lighting = text_of(r, scenario, "lighting"), *curve = text_of(r, scenario, "toneMapping");
    const cJSON *exposure = find(r, scenario, "exposure");
    double size[2] = {768, 768};
    char path[PATH_MAX];
    EC_TRY(take_numbers(r, scenario, "dimensions", sides, 2, size, err));
    EC_TRY(give(r, entry, "size", err, "%.0fx%.0f", size[0], size[1]));
    if (!cJSON_IsTrue(find(r, scenario, "renderSkybox"))) EC_TRY(give(r, entry, "background", err, "transparent"));
    if (curve) EC_TRY(give(r, entry, "tonemap", err, "%s", tone_curve(curve)));
    if (exposure) EC_TRY(give(r, entry, "exposure", err, "%.9g", log2(cJSON_GetNumberValue(exposure))));
    if (!lighting || ec_given_has(r->given, "env") || ec_given_has(r->given, "light")) return EC_OK;
    const bool fits = snprintf(path, sizeof path, "%.*s%s", *lighting == '/' ? 0 : r->base, r->file, lighting) < (int)sizeof path;
    if (!fits || access(path, R_OK) != 0) return ec_fail(err, "its \"lighting\", '%s', cannot be read; put it there, or give one map for all with --env FILE", path);
    return give(r, entry, "env", err, "%s", path);
}

static ec_result give_all(const reading *r, const cJSON *scenario, ec_entry *entry, ec_error *err)
{
    EC_TRY(give_camera(r, scenario, entry, err));
    EC_TRY(give_picture(r, scenario, entry, err));
    EC_TRY(ec_entry_give(entry, r->given, err));
    static const char *const endings[] = {"exr", "png"};
    char path[PATH_MAX];
    for (int i = 0; i < 2; i++) {
        if (snprintf(path, sizeof path, "%s/%s.%s", r->folder, entry->name, endings[i]) >= (int)sizeof path)
            return ec_fail(err, "its path is longer than %d bytes", PATH_MAX - 1);
        EC_TRY(ec_given_add(&entry->given, "output", path, err));
    }
    return EC_OK;
}

static ec_result add(const reading *r, const cJSON *scenario, ec_entries *entries, ec_error *err)
{
    const cJSON *own = cJSON_GetObjectItemCaseSensitive(scenario, "name");
    const char *name = own ? cJSON_GetStringValue(own) : scenario->string, *model = text_of(r, scenario, "model");
    char path[PATH_MAX];
    ec_error why = {0};
    ec_entry *entry;
    if (!name || !*name || *name == '.' || strchr(name, '/') || !strcmp(name, "index"))
        return ec_fail(err, "%s: scenario %u has no usable \"name\"; it may not contain a slash, begin with a dot or be index", r->file,
                       entries->count + 1);
    for (uint32_t i = 0; i < entries->count; i++)
        if (!strcmp(entries->list[i].name, name)) return ec_fail(err, "%s: two scenarios are called '%s'; give one of them another name", r->file, name);
    if (model) snprintf(path, sizeof path, "%.*s%s", *model == '/' ? 0 : r->base, r->file, model);
    EC_TRY(ec_entries_add(entries, name, model ? path : "", &entry, err));
    ec_result result = model ? give_all(r, scenario, entry, &why) : ec_fail(&why, "it has no \"model\", the scene to render");
    if (result != EC_OK && !(entry->why_not = strdup(why.text))) return ec_fail(err, "out of memory for '%s'", name);
    return EC_OK;
}

static ec_result read_text(const char *path, char **text, ec_error *err)
{
    size_t size = 0;
    EC_TRY(ec_image_check_regular(path, err));
    FILE *file = fopen(path, "rb");
    if (!file) return ec_fail(err, "cannot open '%s': %s", path, strerror(errno));
    const bool is_read = getdelim(text, &size, 0, file) >= 0;
    fclose(file);
    return is_read ? EC_OK : ec_fail(err, "cannot read '%s': it is empty or cannot be read", path);
}

ec_result ec_scenarios_read(const char *path, const char *folder, const ec_given_options *given, ec_entries *entries, ec_error *err)
{
    const char *slash = strrchr(path, '/'), *at = NULL;
    char *text = NULL;
    ec_result result = read_text(path, &text, err);
    cJSON *root = result == EC_OK ? cJSON_ParseWithOpts(text, &at, true) : NULL;
    if (result == EC_OK && !root) {
        uint32_t line = 1;
        for (const char *c = text; c < at; c++) line += *c == '\n';
        result = ec_fail(err, "%s: line %u is not valid JSON", path, line);
    }
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "scenarios"), *one;
    if (root && cJSON_GetArraySize(list) == 0) result = ec_fail(err, "%s: it has no \"scenarios\", each with a \"name\" and a \"model\"", path);
    const reading r = {path, folder, slash ? (int)(slash + 1 - path) : 0, given, cJSON_GetObjectItemCaseSensitive(root, "defaults")};
    cJSON_ArrayForEach(one, list) {
        if (result == EC_OK) result = add(&r, one, entries, err);
    }
    cJSON_Delete(root);
    free(text);
    return result;
}
