/* The effects of a render: for each, whether it is called for and why, which kernels it is built into and which buffers it takes. */
#ifndef EC_DEVICE_EFFECTS_H
#define EC_DEVICE_EFFECTS_H

#include <stdbool.h>

#include "pack/called_effects.h"

/* A buffer of the scene's data on the device. */
typedef struct ec_scene_buffer {
    char label[24];
    uint64_t effects; /* any of these needs it; 0: always there */
    uint64_t bytes;   /* 0: not allocated */
} ec_scene_buffer;

enum { EC_SCENE_BUFFERS = 22 };

typedef struct ec_render_effects {
    ec_effects called;   /* by the scene and the options */
    uint64_t built;      /* EC_FEATURE_* in the kernels: more than are called for with all_effects */
    uint64_t without;    /* switched off on purpose */
    uint64_t never;      /* in no kernel, not even with all_effects */
    uint32_t launched;   /* stages: 1 << ec_stage_id */
    ec_scene_buffer buffers[EC_SCENE_BUFFERS];
    uint32_t buffer_count;
} ec_render_effects;

/* One effect in words, as every report prints it; texts may be empty. */
typedef struct ec_effect_row {
    const char *name;
    bool called, built, left_out; /* left_out: by --without, whether it was called for or not */
    char why[EC_EFFECT_WHY + 24];
    char kernels[128], buffers[192]; /* ", " between them */
    uint64_t bytes;                  /* of these buffers; others may share them */
} ec_effect_row;
/* Describes effect i, which is below ec_feature_count. */
ec_effect_row ec_effect_describe(const ec_render_effects *effects, uint32_t i);

/* Writes the kernels that are launched: "generate, intersect, shade, connect". */
void ec_effects_kernels(const ec_render_effects *effects, char *text, size_t size);

#endif
