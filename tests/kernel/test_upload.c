/* tier: quick */
/* A CPU uses a scene's large buffers in place, and copies for other devices have the same contents. */
#include <stdlib.h>

#include "base/memory.h"
#include "device/pipeline.h"
#include "support/render_case.h"

enum { ADOPTED = 1 << 20 }; /* bytes: smaller buffers are copied (cl/buffer.c) */

static void make(const ec_scene *scene, const ec_render_options *o, ec_payload *payload, ec_pipeline *p)
{
    const ec_device_kind kind = ec_device_kind_of(&case_cl()->info);
    ec_render_stats stats = {0};
    ec_error err = {0};
    *p = (ec_pipeline){.cl = case_cl(), .compiler = {.report = -1}};
    CHECK_OK(ec_payload_make(scene, o, 1, 1u << kind, NULL, payload, &stats, &err), err);
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) p->accels[a].in_use = payload->head.accels[kind] >> a & 1;
}

static cl_mem on_device(const ec_pipeline *p, const ec_payload_buffer *b)
{
    return b->accel == EC_ACCEL_COUNT ? p->buffers[b->arg] : p->accels[b->accel].buffers[b->arg - EC_ARG_ACCEL];
}

static const void *place(const ec_pipeline *p, const ec_payload_buffer *b)
{
    const void *at = NULL;
    clGetMemObjectInfo(on_device(p, b), CL_MEM_HOST_PTR, sizeof at, &at, NULL);
    return at;
}

static void nothing_large_is_copied(const ec_scene *scene, const ec_render_options *o)
{
    ec_payload payload, before;
    ec_pipeline p;
    ec_error err = {0};
    uint32_t large = 0;
    make(scene, o, &payload, &p);
    memcpy(before.buffers, payload.buffers, sizeof before.buffers);
    before.head = payload.head;
    CHECK_OK(ec_pipeline_upload(&p, &payload, &payload, &err), err);
    for (uint32_t i = 0; i < before.head.buffer_count; i++) {
        const ec_payload_buffer *b = &before.buffers[i];
        if ((b->accel == EC_ACCEL_COUNT && b->arg != EC_ARG_PRIMS) || b->bytes < ADOPTED) continue;
        CHECK_MSG(place(&p, b) == b->data, "%s is copied", b->label);
        large++;
    }
    CHECK_MSG(large >= 3, "%u large buffers", large);
    ec_pipeline_destroy(&p);
}

static void who_shares_gets_copies(const ec_scene *scene, const ec_render_options *o)
{
    ec_payload payload;
    ec_pipeline p;
    ec_error err = {0};
    make(scene, o, &payload, &p);
    CHECK_OK(ec_pipeline_upload(&p, &payload, NULL, &err), err);
    for (uint32_t i = 0; i < payload.head.buffer_count; i++) {
        const ec_payload_buffer *b = &payload.buffers[i];
        void *copy = malloc(b->bytes);
        CHECK(place(&p, b) != b->data);
        CHECK_OK(ec_buffer_read(p.cl, on_device(&p, b), 0, b->bytes, copy, &err), err);
        CHECK_MSG(!memcmp(copy, b->data, b->bytes), "%s", b->label);
        free(copy);
    }
    ec_pipeline_destroy(&p);
    ec_payload_free(&payload);
}

int main(void)
{
    const ec_render_options o = case_quick(case_options(16, 16, 1));
    ec_scene *scene = case_load(OWN_SCENE("ladder/ladder.gltf"), NULL);
    if (case_cl()->info.type & CL_DEVICE_TYPE_CPU) nothing_large_is_copied(scene, &o);
    who_shares_gets_copies(scene, &o);
    ec_scene_free(scene);
    TEST_END();
}
