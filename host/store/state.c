/* The JSON object beside the sums. 64-bit counts are texts: JSON's numbers are doubles. */
#include <cjson/cJSON.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/layout.h"
#include "store/rare_state.h"

enum { FORMAT = 5 };

static void add_count(cJSON *object, const char *name, uint64_t value)
{
    char digits[24];
    snprintf(digits, sizeof digits, "%" PRIu64, value);
    cJSON_AddStringToObject(object, name, digits);
}

static void add_job(cJSON *state, const ec_job *job)
{
    cJSON *identity = cJSON_AddObjectToObject(state, "identity"), *argv = cJSON_AddArrayToObject(state, "command");
    for (uint32_t i = 0; i < job->identity.count; i++)
        cJSON_AddStringToObject(identity, job->identity.traits[i].name, job->identity.traits[i].value);
    for (int i = 0; i < job->argc; i++) cJSON_AddItemToArray(argv, cJSON_CreateString(job->argv[i]));
    cJSON_AddStringToObject(state, "folder", job->folder);
    cJSON_AddStringToObject(state, "device", job->device);
    cJSON_AddNumberToObject(state, "spp", job->spp);
    cJSON_AddNumberToObject(state, "errorTarget", job->error_target);
    cJSON_AddNumberToObject(state, "timeLimit", job->time_limit);
    cJSON_AddNumberToObject(state, "first", job->first);
    cJSON_AddNumberToObject(state, "end", job->end);
    cJSON_AddNumberToObject(state, "endCut", job->cut);
    cJSON_AddBoolToObject(state, "merged", job->merged);
}

/* Writes the slope. A deviation of 0 means that there is none yet. */
static void add_slope(cJSON *state, const ec_slope *s)
{
    cJSON_AddNumberToObject(state, "slope", s->value);
    cJSON_AddNumberToObject(state, "slopeDeviation", isfinite(s->deviation) ? s->deviation : 0);
    cJSON_AddItemToObject(state, "slopeSamples", cJSON_CreateDoubleArray(s->samples, (int)s->count));
    cJSON_AddItemToObject(state, "slopeSquares", cJSON_CreateDoubleArray(s->square, (int)s->count));
}

static void add_past(cJSON *state, const ec_past *past)
{
    cJSON *invalid = cJSON_AddArrayToObject(state, "invalid");
    for (int i = 0; i < EC_STAGE_COUNT; i++) cJSON_AddItemToArray(invalid, cJSON_CreateNumber((double)past->invalid[i]));
    cJSON_AddNumberToObject(state, "next", past->next);
    cJSON_AddNumberToObject(state, "underWay", past->under_way);
    add_count(state, "samples", past->samples);
    add_count(state, "rays", past->rays);
    cJSON_AddNumberToObject(state, "seconds", past->seconds);
    cJSON_AddBoolToObject(state, "allotted", past->allotted);
    cJSON_AddBoolToObject(state, "hasWeights", past->allotment.weight != NULL);
    cJSON_AddNumberToObject(state, "gain", past->allotment.gain);
    cJSON_AddNumberToObject(state, "level", past->allotment.level);
    add_slope(state, &past->slope);
}

static void add_layers(cJSON *state, const ec_layers *layers)
{
    if (!layers->count) return;
    cJSON_AddNumberToObject(state, "layerKinds", layers->kinds);
    cJSON *groups = cJSON_AddArrayToObject(state, "lightGroups");
    for (uint32_t g = 0; g < layers->group_count; g++) cJSON_AddItemToArray(groups, cJSON_CreateString(layers->groups[g]));
}

static void add_parts(cJSON *state, const char *name, const ec_film *film)
{
    cJSON *parts = cJSON_AddArrayToObject(state, name);
    for (uint32_t i = 0; i < film->part_count; i++) {
        const int range[2] = {(int)film->parts[i].first, (int)film->parts[i].count};
        cJSON_AddItemToArray(parts, cJSON_CreateIntArray(range, 2));
    }
}

static void add_film(cJSON *state, const ec_film *film)
{
    add_parts(state, "parts", film);
    if (film->light) add_parts(state, "lightParts", film->light);
    cJSON_AddNumberToObject(state, "replicates", film->replicates);
    cJSON_AddNumberToObject(state, "cut", film->cut);
    if (film->limit > 0) cJSON_AddNumberToObject(state, "limit", (double)film->limit);
    cJSON_AddNumberToObject(state, "featureSets", film->feature_sets);
    cJSON_AddNumberToObject(state, "featureEnd", film->feature_end);
    cJSON_AddNumberToObject(state, "batches", film->batch_count);
    cJSON_AddBoolToObject(state, "hasCounts", film->counts != NULL);
    add_count(state, "invalidValues", film->invalid_count);
    add_layers(state, &film->layers);
    ec_rare_state_add(state, film->rare);
}

char *ec_state_write(const ec_job *job, const ec_film *film, const ec_past *past)
{
    cJSON *state = cJSON_CreateObject();
    cJSON_AddNumberToObject(state, "format", FORMAT);
    add_job(state, job);
    add_past(state, past);
    add_film(state, film);
    char *text = cJSON_PrintUnformatted(state);
    cJSON_Delete(state);
    return text;
}

/* Reading notes whatever is missing or of the wrong kind, and goes on. */
typedef struct reader {
    const cJSON *state;
    bool is_wrong;
} reader;

static double number_of(reader *r, const cJSON *item, double most)
{
    bool fits = cJSON_IsNumber(item) && item->valuedouble >= 0 && item->valuedouble <= most;
    r->is_wrong |= !fits;
    return fits ? item->valuedouble : 0;
}

static double number(reader *r, const char *name, double most)
{
    return number_of(r, cJSON_GetObjectItemCaseSensitive(r->state, name), most);
}

static uint32_t whole(reader *r, const char *name)
{
    double value = number(r, name, INT32_MAX);
    r->is_wrong |= value != floor(value);
    return (uint32_t)value;
}

static const char *text_of(reader *r, const cJSON *item)
{
    r->is_wrong |= !cJSON_IsString(item);
    return cJSON_IsString(item) ? item->valuestring : "";
}

static uint64_t count(reader *r, const char *name)
{
    const char *digits = text_of(r, cJSON_GetObjectItemCaseSensitive(r->state, name));
    r->is_wrong |= !*digits || digits[strspn(digits, "0123456789")] || strlen(digits) > 19;
    return r->is_wrong ? 0 : strtoull(digits, NULL, 10);
}

static bool flag(reader *r, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(r->state, name);
    r->is_wrong |= !cJSON_IsBool(item);
    return cJSON_IsTrue(item);
}

static char *copy(reader *r, const cJSON *item)
{
    char *own = strdup(text_of(r, item));
    r->is_wrong |= !own;
    return own;
}

static void read_job(reader *r, ec_job *job)
{
    const cJSON *item, *identity = cJSON_GetObjectItemCaseSensitive(r->state, "identity");
    const cJSON *argv = cJSON_GetObjectItemCaseSensitive(r->state, "command");
    cJSON_ArrayForEach(item, identity) {
        if (job->identity.count == EC_TRAITS_MAX || !item->string) break;
        ec_trait *trait = &job->identity.traits[job->identity.count++];
        snprintf(trait->name, sizeof trait->name, "%s", item->string);
        snprintf(trait->value, sizeof trait->value, "%s", text_of(r, item));
    }
    r->is_wrong |= !cJSON_IsArray(argv) || cJSON_GetArraySize(argv) < 1;
    job->argv = r->is_wrong ? NULL : calloc((size_t)cJSON_GetArraySize(argv) + 1, sizeof *job->argv);
    r->is_wrong |= !job->argv;
    if (!r->is_wrong) cJSON_ArrayForEach(item, argv) job->argv[job->argc++] = copy(r, item);
    job->folder = copy(r, cJSON_GetObjectItemCaseSensitive(r->state, "folder"));
    job->device = copy(r, cJSON_GetObjectItemCaseSensitive(r->state, "device"));
    job->spp = whole(r, "spp");
    job->error_target = number(r, "errorTarget", 1e12);
    job->time_limit = number(r, "timeLimit", 1e12);
    job->first = whole(r, "first");
    job->end = whole(r, "end");
    job->cut = whole(r, "endCut");
    job->merged = flag(r, "merged");
}

/* Reads numbers of any sign, at most EC_SLOPE_ROUNDS; returns how many there are. */
static uint32_t reals(reader *r, const char *name, double *values)
{
    const cJSON *item, *array = cJSON_GetObjectItemCaseSensitive(r->state, name);
    uint32_t n = 0;
    r->is_wrong |= !cJSON_IsArray(array);
    cJSON_ArrayForEach(item, array) {
        r->is_wrong |= !cJSON_IsNumber(item) || !isfinite(item->valuedouble) || n == EC_SLOPE_ROUNDS;
        if (r->is_wrong) return 0;
        values[n++] = item->valuedouble;
    }
    return n;
}

static void read_slope(reader *r, ec_slope *s)
{
    const double deviation = number(r, "slopeDeviation", 1e12);
    s->value = number(r, "slope", 1e12);
    s->deviation = deviation > 0 ? deviation : INFINITY;
    s->count = reals(r, "slopeSamples", s->samples);
    r->is_wrong |= reals(r, "slopeSquares", s->square) != s->count;
}

static void read_past(reader *r, ec_past *past)
{
    const cJSON *invalid = cJSON_GetObjectItemCaseSensitive(r->state, "invalid");
    for (int i = 0; i < EC_STAGE_COUNT; i++) past->invalid[i] = (uint64_t)number_of(r, cJSON_GetArrayItem(invalid, i), 1e15);
    past->next = whole(r, "next");
    past->under_way = whole(r, "underWay");
    past->samples = count(r, "samples");
    past->rays = count(r, "rays");
    past->seconds = number(r, "seconds", 1e12);
    past->allotted = flag(r, "allotted");
    past->allotment.gain = number(r, "gain", 1);
    past->allotment.level = number(r, "level", 1e12);
    read_slope(r, &past->slope);
}

static void read_layers(reader *r, ec_layers *layers)
{
    const cJSON *item, *groups = cJSON_GetObjectItemCaseSensitive(r->state, "lightGroups");
    if (!cJSON_HasObjectItem(r->state, "layerKinds")) return;
    layers->kinds = whole(r, "layerKinds");
    r->is_wrong |= layers->kinds >> EC_LAYER_KINDS != 0 || !cJSON_IsArray(groups);
    cJSON_ArrayForEach(item, groups) {
        const char *name = text_of(r, item);
        r->is_wrong |= !*name || strlen(name) >= EC_GROUP_NAME || layers->group_count == EC_GROUPS_MOST;
        if (r->is_wrong) return;
        snprintf(layers->groups[layers->group_count++], EC_GROUP_NAME, "%s", name);
    }
    layers->count = (uint32_t)__builtin_popcount(layers->kinds) + layers->group_count;
}

static uint32_t read_parts(reader *r, const char *name, ec_film_part **read)
{
    const cJSON *item, *parts = cJSON_GetObjectItemCaseSensitive(r->state, name);
    uint32_t count = 0;
    *read = calloc((size_t)cJSON_GetArraySize(parts) + 1, sizeof **read);
    r->is_wrong |= !*read || !cJSON_IsArray(parts);
    if (r->is_wrong) return 0;
    cJSON_ArrayForEach(item, parts) {
        ec_film_part *part = &(*read)[count++];
        part->first = (uint32_t)number_of(r, cJSON_GetArrayItem(item, 0), INT32_MAX);
        part->count = (uint32_t)number_of(r, cJSON_GetArrayItem(item, 1), INT32_MAX);
        r->is_wrong |= !ec_film_part_is_sound(part->first, part->count);
    }
    return count;
}

static void read_film(reader *r, ec_state_film *film)
{
    const cJSON *parts = cJSON_GetObjectItemCaseSensitive(r->state, "parts");
    film->replicates = whole(r, "replicates");
    film->cut = whole(r, "cut");
    film->limit = cJSON_HasObjectItem(r->state, "limit") ? (float)number(r, "limit", FLT_MAX) : 0;
    film->feature_sets = whole(r, "featureSets");
    r->is_wrong |= film->feature_sets > 2;
    film->feature_end = (uint32_t)number(r, "featureEnd", UINT32_MAX);
    film->batch_count = whole(r, "batches");
    film->has_counts = flag(r, "hasCounts");
    film->has_weights = flag(r, "hasWeights");
    film->invalid_count = count(r, "invalidValues");
    r->is_wrong |= !ec_rare_state_read(r->state, &film->rare);
    read_layers(r, &film->layers);
    const int most = cJSON_GetArraySize(parts);
    const bool fits = film->replicates >= 1 && film->replicates <= EC_REPLICATES_MOST && (film->batch_count >= 1) == (most >= 1) &&
                      (most >= 1 || !film->cut) && film->cut < EC_BATCH_MOST && (most == 1 || !film->has_counts);
    r->is_wrong |= !fits;
    film->part_count = read_parts(r, "parts", &film->parts);
    film->has_light = cJSON_HasObjectItem(r->state, "lightParts");
    if (film->has_light) film->light_part_count = read_parts(r, "lightParts", &film->light_parts);
}

ec_result ec_state_read(const char *text, const char *path, ec_stored *s, ec_state_film *film, ec_error *err)
{
    cJSON *state = cJSON_Parse(text);
    reader r = {.state = state};
    double format = cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(state, "format"));
    ec_result result = EC_OK;
    if (!state) {
        result = ec_fail(err, "cannot read '%s': its eclat.state is not JSON; use an older file or render it again", path);
    } else if (format != FORMAT) {
        result = ec_fail(err, "cannot read '%s': it was written by another version of eclat (format %g, this one reads %d); use that version, or render it again",
                         path, format, FORMAT);
    } else {
        read_job(&r, &s->job);
        read_past(&r, &s->past);
        read_film(&r, film);
        r.is_wrong |= !film->batch_count && !s->past.under_way;
        if (r.is_wrong)
            result = ec_fail(err, "cannot read '%s': its description of its sums makes no sense; use an older file or render it again", path);
    }
    cJSON_Delete(state);
    return result;
}
