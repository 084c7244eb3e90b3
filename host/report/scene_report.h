/* Contents of a scene and the cost of rendering it, as text and as JSON. */
#ifndef EC_REPORT_SCENE_REPORT_H
#define EC_REPORT_SCENE_REPORT_H

#include <stdint.h>
#include <stdio.h>

#include "device/effects.h"
#include "device/probe.h"
#include "report/json.h"
#include "scene/scene.h"

/* An accelerator with its measurements; refused: why it was not measured, or empty. */
typedef struct ec_accel_report {
    const char *name;
    ec_accel_probe probe;
    char refused[256];
} ec_accel_report;

typedef struct ec_scene_report {
    const char *path;
    const ec_scene *scene;
    uint32_t emissive_triangles; /* triangles whose material emits or is unlit */
    uint32_t light_types[3];     /* by ec_light_type */
    ec_render_effects effects;   /* those of a render with the given options */
    uint64_t device_bytes;       /* the scene's buffers on the device */
    uint64_t peak_memory_bytes;  /* of this process, which loads the scene and builds the BVH */
    double load_seconds;
    ec_bvh_stats bvh;
    bool has_light, takes_studio; /* takes_studio: the scene has no light, and no environment was given */
    const char *device;          /* the device on which accelerators were measured */
    ec_accel_report accels[EC_ACCEL_COUNT];
    uint32_t accel_count;        /* 0: none were asked for */
} ec_scene_report;

/* Counts what the scene alone tells. */
ec_result ec_scene_report_count(ec_scene_report *report, ec_error *err);

void ec_scene_report_text(const ec_scene_report *report, FILE *to);
ec_result ec_scene_report_json(const ec_scene_report *report, FILE *to, ec_error *err);

/* Report the materials that cast caustics, and how. */
void ec_caustics_text(const ec_scene_report *report, FILE *to);
void ec_caustics_json(const ec_scene_report *report, cJSON *root);

/* Writes e.g. "0 'Main' (perspective, 39.3 degrees high)". */
void ec_camera_describe(const ec_scene *scene, uint32_t index, char *text, size_t size);

#endif
