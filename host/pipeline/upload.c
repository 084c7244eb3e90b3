/* A cargo's buffers, put on a device. */
#include <stdlib.h>

#include "pipeline/pipeline.h"

static cl_mem *place_of(ec_pipeline *p, const ec_cargo_buffer *b)
{
    if (b->accel == EC_ACCEL_COUNT) return &p->buffers[b->arg];
    return p->accels[b->accel].in_use ? &p->accels[b->accel].buffers[b->arg - EC_ARG_ACCEL] : NULL;
}

static ec_result upload(ec_pipeline *p, const ec_cargo_buffer *b, ec_error *err)
{
    cl_mem *place = place_of(p, b);
    if (!place) return EC_OK;
    EC_TRY(ec_buffer_create(p->cl, b->label, b->bytes + b->slack, b->slack ? NULL : b->data, place, err));
    return b->slack ? ec_buffer_write(p->cl, *place, 0, b->bytes, b->data, err) : EC_OK;
}

ec_result ec_pipeline_upload(ec_pipeline *p, const ec_cargo *cargo, ec_error *err)
{
    for (uint32_t i = 0; i < cargo->head.buffer_count; i++) EC_TRY(upload(p, &cargo->buffers[i], err));
    return EC_OK;
}

ec_result ec_pipeline_unload(ec_pipeline *p, ec_cargo *cargo, ec_error *err)
{
    ec_result result = EC_OK;
    for (uint32_t i = 0; i < cargo->head.buffer_count && result == EC_OK; i++) {
        ec_cargo_buffer *b = &cargo->buffers[i];
        result = upload(p, b, err);
        free(b->owned);
        b->owned = NULL;
    }
    ec_cargo_free(cargo);
    return result;
}
