/* KHR_lights_punctual: places the file's lights at their nodes. */
#include "gltf/flatten.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"

static void aim(const double linear[9], float direction[3])
{
    double v[3]; /* local -z */
    for (int i = 0; i < 3; i++) v[i] = -linear[3 * i + 2];
    bool usable = ec_normalize(v);
    for (int i = 0; i < 3; i++) direction[i] = usable ? (float)v[i] : i == 2 ? -1.0f : 0.0f;
}

ec_result ec_gltf_lights_place(const ec_gltf *g, const ec_placement_list *placements, ec_scene *s, const ec_log *log,
                               ec_error *err)
{
    s->lights = calloc((size_t)placements->count + 1, sizeof *s->lights);
    if (!s->lights) return ec_fail(err, "%s: out of memory for lights", g->path);
    for (uint32_t i = 0; i < placements->count; i++) {
        const ec_placement *at = &placements->items[i];
        int32_t index = g->nodes[at->node].light;
        if (index < 0 || at->extra || at->hidden) continue;
        ec_light light = g->lights[index];
        bool finite = true;
        aim(at->linear, light.direction);
        for (int k = 0; k < 3; k++) {
            light.position[k] = (float)(at->origin[k] - s->center[k]);
            finite = finite && isfinite(light.position[k]);
        }
        const char *name = g->nodes[at->node].name;
        light.name = finite && name ? strdup(name) : NULL;
        if (finite) s->lights[s->light_count++] = light;
        else ec_warn(log, "%s: the light at nodes[%d] stands at infinity; it is left out", g->path, at->node);
    }
    return EC_OK;
}
