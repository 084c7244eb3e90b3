/* Reads buffers by type. Every range is checked once, when an accessor is opened; reading is then plain. */
#include "gltf/codecs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The most elements that a file may claim without bytes behind them (no bufferView: zeros). More is an attack, not a mesh. */
#define MAX_IMPLIED_ELEMENTS (1u << 24)

static uint32_t component_size(uint32_t type)
{
    switch (type) {
    case EC_GLTF_BYTE:
    case EC_GLTF_UBYTE: return 1;
    case EC_GLTF_SHORT:
    case EC_GLTF_USHORT: return 2;
    default: return 4;
    }
}

ec_result ec_gltf_check_views(const ec_gltf *g, ec_error *err)
{
    for (uint32_t i = 0; i < g->view_count; i++) {
        const ec_gltf_view *v = &g->views[i];
        uint64_t size = g->buffers[v->buffer].length;
        if (v->offset > size || v->length > size - v->offset)
            return ec_fail(err, "bufferViews[%u] (offset %llu, length %llu) reaches beyond buffers[%d] of %llu "
                           "bytes; the file is damaged or truncated", i, (unsigned long long)v->offset,
                           (unsigned long long)v->length, v->buffer, (unsigned long long)size);
    }
    return EC_OK;
}

/* Tells whether the decoder may be called with these sizes, and its input can stand for so much output: a byte may be a triangle of 12 bytes, or 16
 * equal vertices of 256. */
static bool is_plausible(const ec_gltf_meshopt *p, uint64_t room)
{
    bool attributes = p->mode == EC_MESHOPT_ATTRIBUTES;
    bool stride = attributes ? p->stride >= 4 && p->stride <= 256 && p->stride % 4 == 0 : p->stride == 2 || p->stride == 4;
    bool filter = !p->filter || (attributes && (p->filter == EC_MESHOPT_EXPONENTIAL || p->stride == 8 ||
                                                (p->stride == 4 && p->filter != EC_MESHOPT_QUATERNION)));
    return stride && filter && p->count <= INT32_MAX && p->count * p->stride <= room && p->count * p->stride / 4096 <= p->length &&
           (p->mode != EC_MESHOPT_TRIANGLES || p->count % 3 == 0);
}

static ec_result unpack(ec_gltf *g, int32_t view, ec_error *err)
{
    ec_gltf_view *v = &g->views[view];
    const ec_gltf_meshopt *p = &v->packed;
    const ec_gltf_buffer *b = &g->buffers[p->buffer];
    if (v->owned) return EC_OK;
    if (!b->data || p->offset > b->length || p->length > b->length - p->offset)
        return ec_fail(err, "%s: bufferViews[%d], compressed by meshopt, reaches beyond buffers[%d]; the file is damaged or truncated", g->path,
                       view, p->buffer);
    if (!is_plausible(p, v->length))
        return ec_fail(err, "%s: bufferViews[%d], compressed by meshopt: %llu elements of %u bytes do not fit its mode, filter or length",
                       g->path, view, (unsigned long long)p->count, p->stride);
    v->length = p->count * p->stride;
    v->owned = calloc(v->length + 256, 1); /* the decoder's filters work on whole blocks */
    if (!v->owned) return ec_fail(err, "%s: out of memory for bufferViews[%d]", g->path, view);
    if (ec_meshopt_decode(p, b->data + p->offset, v->owned)) return EC_OK;
    return ec_fail(err, "%s: bufferViews[%d], compressed by meshopt: its data are broken%s", g->path, view, ec_meshopt_hint(p, b->data + p->offset));
}

/* Locates `count` elements of `size` bytes in a view; *data is the first. */
static ec_result locate(ec_gltf *g, int32_t view, uint64_t offset, uint64_t count, uint64_t size, uint64_t stride,
                        const uint8_t **data, const char *where, ec_error *err)
{
    ec_gltf_view *v = &g->views[view];
    const ec_gltf_buffer *b = &g->buffers[v->buffer];
    if (v->packed.mode && ec_has_meshopt) EC_TRY(unpack(g, view, err));
    if (!b->data && !v->owned)
        return ec_fail(err, "%s: %s reads buffers[%d], which has neither uri nor binary chunk", g->path, where,
                       v->buffer);
    bool fits = offset <= v->length && size <= v->length - offset &&
                (count - 1) <= (v->length - offset - size) / stride;
    if (!fits)
        return ec_fail(err, "%s: %s needs %llu elements of %llu bytes from offset %llu, more than the %llu bytes of "
                       "bufferViews[%d]; the file is damaged or its count is wrong", g->path, where,
                       (unsigned long long)count, (unsigned long long)size, (unsigned long long)offset,
                       (unsigned long long)v->length, view);
    *data = (v->owned ? v->owned : b->data + v->offset) + offset;
    return EC_OK;
}

static uint32_t load_index(const uint8_t *p, uint32_t type)
{
    if (type == EC_GLTF_UBYTE) return *p;
    if (type == EC_GLTF_USHORT) return (uint32_t)p[0] | (uint32_t)p[1] << 8;
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* Writes the sparse replacements over `dense` (count x size bytes). */
static ec_result apply_sparse(ec_gltf *g, const ec_gltf_accessor *a, uint64_t size, uint8_t *dense,
                              const char *where, ec_error *err)
{
    const ec_gltf_sparse *s = &a->sparse;
    uint32_t index_size = component_size(s->index_type);
    const uint8_t *indices, *values;
    EC_TRY(locate(g, s->index_view, s->index_offset, s->count, index_size, index_size, &indices, where, err));
    EC_TRY(locate(g, s->value_view, s->value_offset, s->count, size, size, &values, where, err));
    for (uint64_t i = 0; i < s->count; i++) {
        uint32_t target = load_index(indices + i * index_size, s->index_type);
        if (target >= a->count)
            return ec_fail(err, "%s: %s: sparse index %u (entry %llu) is out of range, the accessor has %llu elements",
                           g->path, where, target, (unsigned long long)i, (unsigned long long)a->count);
        memcpy(dense + target * size, values + i * size, size);
    }
    return EC_OK;
}

static ec_result merge_sparse(ec_gltf *g, ec_gltf_accessor *a, uint64_t size, const char *where, ec_error *err)
{
    uint8_t *dense = calloc(a->count, size);
    if (!dense) return ec_fail(err, "%s: %s: out of memory", g->path, where);
    if (a->data)
        for (uint64_t i = 0; i < a->count; i++) memcpy(dense + i * size, a->data + i * a->stride, size);
    ec_result result = apply_sparse(g, a, size, dense, where, err);
    if (result != EC_OK) {
        free(dense);
        return result;
    }
    a->data = a->owned = dense;
    a->stride = size;
    return EC_OK;
}

ec_result ec_gltf_accessor_open(ec_gltf *g, int32_t accessor, const char *what, ec_error *err)
{
    ec_gltf_accessor *a = &g->accessors[accessor];
    if (a->open) return EC_OK;
    char where[256];
    snprintf(where, sizeof where, "%s: accessors[%d]", what, accessor);
    if (!a->components)
        return ec_fail(err, "%s: %s has a type other than SCALAR, VEC2, VEC3 or VEC4, which cannot be used there",
                       g->path, where);
    uint64_t size = (uint64_t)a->components * component_size(a->component_type);
    a->stride = size;
    if (a->view >= 0) {
        uint32_t stride = g->views[a->view].stride;
        if (stride && stride < size)
            return ec_fail(err, "%s: %s: byteStride %u of bufferViews[%d] is less than an element's %llu bytes",
                           g->path, where, stride, a->view, (unsigned long long)size);
        if (stride) a->stride = stride;
        EC_TRY(locate(g, a->view, a->offset, a->count, size, a->stride, &a->data, where, err));
    } else if (a->count > MAX_IMPLIED_ELEMENTS) {
        return ec_fail(err, "%s: %s claims %llu elements without a bufferView to hold them", g->path, where,
                       (unsigned long long)a->count);
    }
    if (a->sparse.count > a->count)
        return ec_fail(err, "%s: %s replaces %llu elements but has only %llu", g->path, where,
                       (unsigned long long)a->sparse.count, (unsigned long long)a->count);
    if (a->sparse.count) EC_TRY(merge_sparse(g, a, size, where, err));
    a->open = true;
    return EC_OK;
}

/* Loads a component of any type; floats have a faster path below. */
static float load_component(const uint8_t *p, uint32_t type, bool normalized)
{
    const uint32_t size = component_size(type), word = load_index(p, size == 4 ? EC_GLTF_UINT : size == 2 ? EC_GLTF_USHORT : EC_GLTF_UBYTE);
    float value;
    switch (type) {
    case EC_GLTF_BYTE:
        value = (float)(int8_t)word;
        return !normalized ? value : value < -127.0f ? -1.0f : value / 127.0f;
    case EC_GLTF_SHORT:
        value = (float)(int16_t)word;
        return !normalized ? value : value < -32767.0f ? -1.0f : value / 32767.0f;
    case EC_GLTF_UBYTE: return normalized ? (float)word / 255.0f : (float)word;
    case EC_GLTF_USHORT: return normalized ? (float)word / 65535.0f : (float)word;
    default: return (float)word;
    }
}

void ec_gltf_accessor_floats(const ec_gltf_accessor *a, uint64_t element, uint32_t count, float *out)
{
    if (!a->data) {
        memset(out, 0, count * sizeof *out);
        return;
    }
    const uint8_t *p = a->data + element * a->stride;
    uint32_t size = component_size(a->component_type);
    if (a->component_type == EC_GLTF_FLOAT) { /* the usual case, without checking the type of each component */
        for (uint32_t c = 0; c < count; c++) {
            uint32_t word = load_index(p + 4 * c, EC_GLTF_UINT);
            memcpy(&out[c], &word, sizeof word);
        }
        return;
    }
    for (uint32_t c = 0; c < count; c++) out[c] = load_component(p + c * size, a->component_type, a->normalized);
}

uint32_t ec_gltf_accessor_index(const ec_gltf_accessor *a, uint64_t element)
{
    return a->data ? load_index(a->data + element * a->stride, a->component_type) : 0;
}
