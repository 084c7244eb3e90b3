#include "jobs/channel_list.h"

#include <string.h>

#include "base/text.h"
#include "image/exr_pack.h"
#include "jobs/option.h"

_Static_assert(EC_CHANNEL_ROWS <= 64, "a bit each");

static ec_channel_set up_to(ec_channel_choice most)
{
    ec_channel_set set = 0;
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (ec_channel_rows[i].when <= most) set |= 1ull << i;
    return set;
}

ec_channel_set ec_channels_all(void) { return up_to(EC_CHANNEL_OF_ALL); }

ec_channel_set ec_channels_default(void) { return up_to(EC_CHANNEL_DEFAULT); }

ec_channel_set ec_channels_of(ec_plane plane)
{
    ec_channel_set set = 0;
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (ec_channel_rows[i].plane == plane) set |= 1ull << i;
    return set;
}

uint32_t ec_channels_layers(ec_channel_set set)
{
    uint32_t kinds = 0;
    for (uint32_t k = 0; k < EC_LAYER_KINDS; k++)
        if (set & ec_channels_of(EC_PLANE_LAYER + k)) kinds |= 1u << k;
    return kinds;
}

uint32_t ec_channels_mattes(ec_channel_set set)
{
    uint32_t kinds = 0;
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
        if (set & ec_channels_of(EC_PLANE_MATTE + k)) kinds |= 1u << k;
    return kinds;
}

static bool is_word(const char *word, size_t size, const char *name) { return strlen(name) == size && !strncmp(word, name, size); }

/* Returns the channels of this name or layer; none if there is no such channel. */
static ec_channel_set named(const char *word, size_t size)
{
    ec_channel_set set = 0;
    if (is_word(word, size, "all")) return ec_channels_all();
    if (is_word(word, size, "default")) return ec_channels_default();
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++) {
        const char *name = ec_channel_rows[i].name;
        if (ec_channel_is_matte(&ec_channel_rows[i]) && is_word(word, size, "cryptomatte")) set |= 1ull << i;
        if (is_word(word, size, name) || (size > 0 && !strncmp(name, word, size) && name[size] == '.')) set |= 1ull << i;
    }
    return set;
}

ec_result ec_parse_channels(const char *option, const char *text, ec_channel_set *set, ec_error *err)
{
    *set = ec_channels_of(EC_PLANE_RGB);
    for (const char *word = text;; word++) {
        const size_t size = strcspn(word, ",");
        const ec_channel_set found = named(word, size);
        if (!found)
            return ec_usage(err, "--%s: '%.*s' is not a channel; give all, default, A, samples, stderr, low95, high95, heavy, clamped, denoised, best, albedo, "
                                 "normal, depth, direct, indirect, position, uv, motion, cryptomatte, CryptoObject, CryptoMaterial, CryptoAsset or a single channel of a layer, such as stderr.Y, separated by commas", option, EC_CUT(word, size < 80 ? (int)size : 80));
        *set |= found;
        word += size;
        if (!*word) return EC_OK;
    }
}

uint32_t ec_channels_bytes(ec_channel_set set)
{
    uint32_t bytes = 0;
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (set >> i & 1) bytes += ec_channel_count(&ec_channel_rows[i]) * ec_channel_bytes(ec_channel_rows[i].type);
    return bytes;
}
