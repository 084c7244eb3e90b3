/* Estimates what a scene takes on a device, before there is one. */
#include "device/estimate.h"

#include "device/pipeline.h"

static uint64_t sum_bytes(const ec_scene *scene, const ec_pack *pack, uint32_t ref_count, ec_render_effects *effects)
{
    ec_upload plan[EC_SCENE_BUFFERS];
    uint32_t count = ec_upload_plan(scene, pack, plan, effects);
    uint64_t triangles = scene->triangle_count, bytes = 0;
    for (uint32_t i = 0; i < count; i++) bytes += plan[i].buffer.bytes;
    uint64_t blocks = ref_count / 7, boxes = ref_count > triangles ? blocks : 0; /* leaf blocks seven eighths full */
    bytes += blocks * sizeof(ec_tri8) + boxes * sizeof(ec_box8) + ref_count / 20 * sizeof(ec_bvh8_node);
    if (scene->placed_count) bytes += scene->placed_count * (sizeof(ec_instance) + sizeof(ec_bvh8_node) / 4);
    return bytes;
}

ec_result ec_scene_estimate(const ec_scene *scene, const ec_render_options *options, uint32_t ref_count, uint64_t *device_bytes,
                            ec_render_effects *effects, ec_error *err)
{
    const ec_scene *called_for;
    ec_payload *payload = calloc(1, sizeof *payload);
    if (!payload) return ec_fail(err, "out of memory for what a render is made of");
    ec_result result = ec_payload_choose(payload, &scene, &called_for, options, err);
    if (result == EC_OK) result = ec_payload_pack(payload, scene, called_for, options, NULL, 0, err);
    if (result == EC_OK) {
        *effects = payload->head.effects;
        *device_bytes = sum_bytes(scene, &payload->pack, ref_count, effects);
    }
    ec_payload_free(payload);
    free(payload);
    return result;
}
