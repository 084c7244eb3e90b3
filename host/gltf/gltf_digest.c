/* Hashes every file of a document: two documents with the same digest give the same scenes. */
#include "base/freed.h"
#include "base/sha256.h"
#include "gltf/gltf.h"

/* Chains digests: hashes the digest so far, the length, and the bytes. */
void ec_gltf_digest_add(ec_gltf *g, const uint8_t *bytes, uint64_t length)
{
    ec_sha256 hash;
    ec_sha256_begin(&hash);
    ec_sha256_add(&hash, g->digest, sizeof g->digest);
    ec_sha256_add(&hash, &length, sizeof length);
    ec_sha256_add(&hash, bytes, (size_t)length);
    ec_sha256_end(&hash, g->digest);
}

/* Adds the file of an image. One that cannot be read is skipped, as the scene does without it. */
static void add_image(ec_gltf *g, const ec_gltf_image *image)
{
    EC_FREED uint8_t *bytes = NULL;
    uint64_t length = 0;
    if (!image->uri || !strncmp(image->uri, "data:", 5)) return; /* it is part of the document */
    ec_gltf_uri_load(g, "image", image->uri, &bytes, &length, NULL);
    ec_gltf_digest_add(g, bytes, length);
}

void ec_gltf_digest_parts(ec_gltf *g)
{
    for (uint32_t i = 0; i < g->buffer_count; i++)
        if (g->buffers[i].owned) ec_gltf_digest_add(g, g->buffers[i].data, g->buffers[i].length);
    for (uint32_t i = 0; i < g->image_count; i++) add_image(g, &g->images[i]);
}
