/* Puts a payload's buffers on a device. */
#include <stdlib.h>

#include "device/pipeline.h"
#include "scene/texels.h"

/* Returns where a buffer goes; NULL: this device does not use it. */
static cl_mem *place_of(ec_pipeline *p, const ec_payload_buffer *b)
{
    if (b->accel == EC_ACCEL_COUNT) return &p->buffers[b->arg];
    return p->accels[b->accel].in_use ? &p->accels[b->accel].buffers[b->arg - EC_ARG_ACCEL] : NULL;
}

/* Releases first what another render has left on the device and this one does not need: there may not be room for both. */
static void make_room(ec_pipeline *p, const ec_payload *payload, ec_fingerprint keys[EC_PAYLOAD_BUFFERS])
{
    for (uint32_t i = 0; i < payload->head.buffer_count; i++) {
        const ec_payload_buffer *b = &payload->buffers[i];
        keys[i] = place_of(p, b) ? ec_buffer_key(b->label, b->bytes, b->slack, b->data) : (ec_fingerprint){{0}};
    }
    ec_buffers_keep_only(p->cl, keys, payload->head.buffer_count);
}

static void CL_CALLBACK free_memory(cl_mem buffer, void *memory)
{
    (void)buffer;
    free(memory);
}

static void CL_CALLBACK leave_texels(cl_mem buffer, void *texels)
{
    (void)buffer;
    ec_texels_leave(texels);
}

/* Lets the device work on the payload's memory itself, and free it. Returns false if that is not possible. */
static bool adopt(ec_pipeline *p, ec_payload_buffer *b, cl_mem *place)
{
    if (!b->owned && !b->texels) return false;
    void *user = b->owned ? b->owned : b->texels;
    if (!ec_buffer_adopt(p->cl, b->label, b->bytes + b->slack, (void *)b->data, b->owned ? free_memory : leave_texels, user, place)) return false;
    b->owned = NULL;
    b->texels = NULL;
    return true;
}

ec_result ec_pipeline_upload(ec_pipeline *p, const ec_payload *payload, ec_payload *spent, ec_error *err)
{
    ec_fingerprint keys[EC_PAYLOAD_BUFFERS];
    bool keeps = p->cl->keeps_buffers;
    ec_result result = EC_OK;
    if (keeps) make_room(p, payload, keys);
    for (uint32_t i = 0; i < payload->head.buffer_count && result == EC_OK; i++) {
        const ec_payload_buffer *b = &payload->buffers[i];
        cl_mem *place = place_of(p, b);
        if (place && b->accel < EC_ACCEL_COUNT) p->accels[b->accel].bytes += b->bytes;
        if (place && spent && !keeps && adopt(p, &spent->buffers[i], place)) continue;
        if (place) result = ec_buffer_put(p->cl, b->label, b->bytes, b->slack, b->data, keeps ? &keys[i] : NULL, place, err);
        if (spent) ec_payload_buffer_free(&spent->buffers[i]);
    }
    if (spent) ec_payload_free(spent);
    return result;
}
