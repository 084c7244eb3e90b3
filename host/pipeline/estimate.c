/* What a scene will take on a device, before it is there. */
#include "pipeline/pipeline.h"

ec_result ec_scene_estimate(const ec_scene *scene, uint32_t ref_count, uint64_t *device_bytes, ec_render_effects *effects, ec_error *err)
{
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    ec_upload plan[EC_SCENE_BUFFERS];
    const ec_render_options by_default = {0};
    *effects = (ec_render_effects){0};
    ec_pipeline_effects(&by_default, &pack, effects);
    uint32_t count = ec_upload_plan(scene, &pack, plan, effects);
    uint64_t triangles = scene->triangle_count, bytes = 0;
    for (uint32_t i = 0; i < count; i++) bytes += plan[i].buffer.bytes;
    uint64_t blocks = ref_count / 7, boxes = ref_count > triangles ? blocks : 0; /* leaf blocks seven eighths full */
    bytes += blocks * sizeof(ec_tri8) + boxes * sizeof(ec_box8) + ref_count / 20 * sizeof(ec_bvh8_node);
    if (scene->placed_count) bytes += scene->placed_count * (sizeof(ec_instance) + sizeof(ec_bvh8_node) / 4);
    *device_bytes = bytes;
    ec_pack_free(&pack);
    return EC_OK;
}
