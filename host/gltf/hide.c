/* Leaves out surfaces whose coverage is 0 everywhere: they are not seen, cast no shadow and give no light. Rays then need not visit them, and their
 * materials call for no effects. */
#include "base/freed.h"
#include "gltf/flatten.h"
#include "scene/texture_range.h"

typedef struct hiding {
    ec_gltf *g;
    const ec_placement_list *placements;
    const bool *hidden;      /* by material, whatever the vertex colours, which can only make alpha less */
    uint64_t drawn, triangles; /* primitives that stay; triangles of those that do not */
} hiding;

static void look(hiding *h, bool hide)
{
    for (uint32_t i = 0; i < h->placements->count; i++) {
        int32_t mesh = h->placements->items[i].mesh;
        for (uint32_t k = 0; mesh >= 0 && k < h->g->meshes[mesh].primitive_count; k++) {
            ec_gltf_primitive *p = &h->g->meshes[mesh].primitives[k];
            if (!p->drawn) continue;
            if (!h->hidden[p->scene_material]) h->drawn++;
            else if (hide) p->drawn = false;
            else h->triangles += p->triangle_count;
        }
    }
}

/* Drops the textures of a material that is not shown, so that no texture coordinates are needed. */
static void strip(ec_material *m)
{
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++) m->textures[slot].texture = -1;
}

ec_result ec_gltf_hide(ec_gltf *g, const ec_placement_list *placements, ec_scene *s, const ec_log *log, ec_error *err)
{
    EC_FREED bool *hidden = calloc((size_t)s->material_count + 1, sizeof *hidden);
    hiding h = {.g = g, .placements = placements, .hidden = hidden};
    if (!hidden) return ec_fail(err, "%s: out of memory for %u materials", g->path, s->material_count);
    for (uint32_t m = 0; m < s->material_count; m++) hidden[m] = ec_alpha_hides(s, &s->materials[m], 1.0f, true);
    look(&h, false);
    if (h.drawn && h.triangles) {
        look(&h, true);
        for (uint32_t m = 0; m < s->material_count; m++)
            if (hidden[m]) strip(&s->materials[m]);
        ec_note(log, "%s: %llu triangles that alpha hides are left out", g->path, (unsigned long long)h.triangles);
    } else if (!h.drawn && h.triangles)
        ec_warn(log, "%s: the picture will show no surface: the alpha of all materials is 0, or under their cut-off", g->path);
    return EC_OK;
}
