/* Contents of a scene and the cost of rendering it, as text and as JSON. */
#ifndef EC_REPORT_SCENE_REPORT_H
#define EC_REPORT_SCENE_REPORT_H

#include <stdint.h>
#include <stdio.h>

#include "device/effects.h"
#include "device/probe.h"
#include "report/json.h"
#include "scene/scene.h"

/* One accelerator, measured; refused: why it was not, or empty. */
typedef struct ec_accel_report {
    const char *name;
    ec_accel_probe probe;
    char refused[256];
} ec_accel_report;

typedef struct ec_scene_report {
    const char *path;
    const ec_scene *scene;
    uint32_t emissive_triangles; /* whose material emits or is unlit */
    uint32_t light_types[3];     /* by ec_light_type */
    ec_render_effects effects;   /* of a render with the options given */
    uint64_t device_bytes;       /* the scene's buffers on the device */
    uint64_t peak_memory_bytes;  /* of this process: loading, and building the BVH */
    double load_seconds;
    ec_bvh_stats bvh;
    bool has_light, takes_studio; /* takes_studio: as it has none and no environment was given */
    const char *device;          /* on which they were measured */
    ec_accel_report accels[EC_ACCEL_COUNT];
    uint32_t accel_count;        /* 0: none was asked for */
} ec_scene_report;

/* Fills what can be counted in the scene. */
ec_result ec_scene_report_count(ec_scene_report *report, ec_error *err);

void ec_scene_report_text(const ec_scene_report *report, FILE *to);
ec_result ec_scene_report_json(const ec_scene_report *report, FILE *to, ec_error *err);

/* Materials that cast caustics, and how. */
void ec_caustics_text(const ec_scene_report *report, FILE *to);
void ec_caustics_json(const ec_scene_report *report, cJSON *root);

/* "0 'Main' (perspective, 39.3 degrees high)" */
void ec_camera_describe(const ec_scene *scene, uint32_t index, char *text, size_t size);

#endif
