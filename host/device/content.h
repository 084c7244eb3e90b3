/* Digests of what the device is given, by which renders are compared: two renders of the same content, options and batches take the same samples. */
#ifndef EC_DEVICE_CONTENT_H
#define EC_DEVICE_CONTENT_H

#include <stdint.h>

typedef enum ec_content_id {
    EC_CONTENT_CAMERA,
    EC_CONTENT_GEOMETRY,   /* triangles, their attributes, places of instances */
    EC_CONTENT_MATERIALS,
    EC_CONTENT_TEXTURES,
    EC_CONTENT_LIGHTS,
    EC_CONTENT_ENVIRONMENT,
    EC_CONTENT_SETTINGS,   /* all else in ec_params, and the effects called for */
    EC_CONTENT_KERNELS,    /* the sources of all kernels in this program */
    EC_CONTENT_COUNT
} ec_content_id;

typedef struct ec_content {
    char digest[EC_CONTENT_COUNT][33]; /* the first 128 bits of SHA-256, in hexadecimal; empty: not known */
    uint64_t called;                   /* EC_FEATURE_*: the effects */
} ec_content;

/* Writes the digest of the kernels alone, which needs no render. */
void ec_content_kernels(char digest[33]);

#endif
