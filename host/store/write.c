#include <stdlib.h>
#include <string.h>

#include "store/layout.h"

typedef struct sum_part {
    char name[EC_PART_NAME];
    ec_channel_name names[EC_SUM_CHANNELS];
    ec_channel channels[EC_SUM_CHANNELS];
} sum_part;

/* Makes the part of some sums. They hardly get smaller by compression, which would cost more time than the disk. */
static ec_exr_part make_part(sum_part *room, uint32_t layer, uint32_t index, const ec_film *film)
{
    uint32_t count;
    ec_sum_part_name(layer, index, room->name);
    if (film->parts[index].batch) count = ec_batch_channels(film->parts[index].batch, film->parts[index].features, room->channels);
    else count = ec_sum_channels(&film->parts[index].sums, film->counts, room->names, room->channels);
    return (ec_exr_part){.name = room->name, .channels = room->channels, .channel_count = count, .is_plain = true};
}

ec_result ec_store_write(const char *path, const ec_job *job, const ec_film *film, const ec_past *past,
                         const ec_exr_part *picture, ec_error *err)
{
    const uint32_t own = film->part_count * (1 + film->layers.count); /* layers have batches whenever the picture has them */
    const uint32_t sums = own + (film->light ? film->light->part_count : 0);
    uint32_t count = 1 + sums;
    const ec_channel weight = {"weight", past->allotment.weight, 1, EC_CHANNEL_FLOAT};
    ec_channel batch[EC_BATCH_CHANNELS];
    ec_exr_part *parts = calloc(sums + 3, sizeof *parts);
    sum_part *rooms = calloc(sums + 1, sizeof *rooms);
    ec_attribute *attributes = calloc(picture->attribute_count + 1, sizeof *attributes);
    char *state = ec_state_write(job, film, past);
    ec_result result = EC_OK;
    if (!parts || !rooms || !attributes || !state) {
        result = ec_fail(err, "out of memory for '%s'", path);
    } else {
        parts[0] = *picture;
        parts[0].name = "picture";
        parts[0].attributes = attributes;
        if (picture->attribute_count) memcpy(attributes, picture->attributes, picture->attribute_count * sizeof *attributes);
        attributes[parts[0].attribute_count++] = (ec_attribute){.name = "eclat.state", .type = EC_ATTR_STRING, .string = state};
        for (uint32_t i = own; i < sums; i++) parts[i + 1] = make_part(&rooms[i], film->layers.count + 1, i - own, film->light);
        for (uint32_t i = 0; i < own; i++) {
            const uint32_t layer = i / film->part_count;
            parts[i + 1] = make_part(&rooms[i], layer, i % film->part_count, layer ? &film->layer_films[layer - 1] : film);
        }
        if (weight.data) parts[count++] = (ec_exr_part){.name = "allotment", .channels = &weight, .channel_count = 1};
        if (past->under_way)
            parts[count++] = (ec_exr_part){.name = "under way",
                                           .channels = batch,
                                           .channel_count = ec_batch_channels(past->batch, past->features, batch),
                                           .is_plain = true};
        result = ec_exr_write_parts(path, film->width, film->height, parts, count, err);
    }
    free(parts);
    free(rooms);
    free(attributes);
    free(state);
    return result;
}
