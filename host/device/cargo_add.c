#include <stdio.h>

#include "device/cargo.h"

void ec_cargo_add(ec_cargo *cargo, uint32_t arg, const char *label, uint64_t bytes, uint64_t slack, const void *data, void *owned)
{
    if (!data) return;
    ec_cargo_buffer *buffer = &cargo->buffers[cargo->head.buffer_count++];
    *buffer = (ec_cargo_buffer){.arg = arg, .accel = EC_ACCEL_COUNT, .bytes = bytes, .slack = slack, .data = data, .owned = owned};
    snprintf(buffer->label, sizeof buffer->label, "%s", label);
}
