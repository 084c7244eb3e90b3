/* Decodes KHR_draco_mesh_compression with libdraco. */
#include <draco/compression/decode.h>

#include <cstdlib>
#include <memory>

extern "C" {
#include "gltf/codecs.h"
}

extern "C" const bool ec_has_draco = true;

namespace {

/* Returns all values of an attribute, one element for each point, malloc'ed; nullptr on failure. */
template <typename T> uint8_t *values_of(const draco::Mesh &mesh, const draco::PointAttribute &attribute)
{
    const int8_t n = attribute.num_components();
    T *values = static_cast<T *>(calloc(size_t(mesh.num_points()) * size_t(n) + 1, sizeof(T)));
    for (draco::PointIndex i(0); values && i < mesh.num_points(); ++i)
        if (!attribute.ConvertValue<T>(attribute.mapped_index(i), n, values + size_t(i.value()) * size_t(n))) {
            free(values);
            return nullptr;
        }
    return reinterpret_cast<uint8_t *>(values);
}

uint8_t *values_as(const draco::Mesh &mesh, const draco::PointAttribute &attribute, uint32_t type)
{
    switch (type) {
    case EC_GLTF_BYTE: return values_of<int8_t>(mesh, attribute);
    case EC_GLTF_UBYTE: return values_of<uint8_t>(mesh, attribute);
    case EC_GLTF_SHORT: return values_of<int16_t>(mesh, attribute);
    case EC_GLTF_USHORT: return values_of<uint16_t>(mesh, attribute);
    case EC_GLTF_UINT: return values_of<uint32_t>(mesh, attribute);
    default: return values_of<float>(mesh, attribute);
    }
}

size_t size_of(uint32_t type)
{
    return type == EC_GLTF_BYTE || type == EC_GLTF_UBYTE ? 1 : type == EC_GLTF_SHORT || type == EC_GLTF_USHORT ? 2 : 4;
}

/* Hands `values` over to the accessor; fails if the data do not have as many elements as the accessor says. */
bool give(ec_gltf_accessor &accessor, uint8_t *values, uint64_t count, uint64_t stride)
{
    if (!values || accessor.count != count) {
        free(values);
        return false;
    }
    accessor.data = accessor.owned = values;
    accessor.stride = stride;
    accessor.open = true;
    return true;
}

bool give_indices(ec_gltf_accessor &accessor, const draco::Mesh &mesh)
{
    if (accessor.open) return true;
    uint32_t *indices = static_cast<uint32_t *>(calloc(3 * size_t(mesh.num_faces()) + 1, sizeof *indices));
    for (draco::FaceIndex f(0); indices && f < mesh.num_faces(); ++f)
        for (int k = 0; k < 3; k++) indices[3 * f.value() + uint32_t(k)] = mesh.face(f)[k].value();
    accessor.component_type = EC_GLTF_UINT;
    accessor.components = 1;
    return give(accessor, reinterpret_cast<uint8_t *>(indices), 3 * uint64_t(mesh.num_faces()), 4);
}

bool give_attribute(ec_gltf_accessor &accessor, const draco::Mesh &mesh, uint32_t id)
{
    if (accessor.open) return true;
    const draco::PointAttribute *attribute = mesh.GetAttributeByUniqueId(id);
    if (!attribute || uint32_t(attribute->num_components()) != accessor.components) return false;
    return give(accessor, values_as(mesh, *attribute, accessor.component_type), mesh.num_points(),
                accessor.components * size_of(accessor.component_type));
}

const char *decode(ec_gltf *g, ec_gltf_primitive *p, const uint8_t *bytes, uint64_t length)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(bytes), length);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return "are broken or truncated";
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (p->indices < 0 || !give_indices(g->accessors[p->indices], *mesh)) return "do not hold as many indices as the primitive says";
    for (uint32_t i = 0; i < p->draco_count; i++)
        if (!give_attribute(g->accessors[p->draco[i].accessor], *mesh, p->draco[i].id))
            return "do not hold the attributes that the primitive names";
    p->mode = EC_GLTF_TRIANGLES; /* strips are decoded to triangles too */
    return nullptr;
}

} // namespace

extern "C" ec_result ec_draco_decode(ec_gltf *g, ec_gltf_primitive *p, const uint8_t *bytes, uint64_t length,
                                     const char *where, ec_error *err)
{
    const char *wrong = "need more memory than there is";
    try {
        wrong = decode(g, p, bytes, length);
    } catch (...) { /* thrown only for lack of memory */
    }
    return wrong ? ec_fail(err, "%s: %s: its Draco data %s", g->path, where, wrong) : EC_OK;
}
