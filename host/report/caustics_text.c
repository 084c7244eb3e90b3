/* Reports the bodies that light paths would be aimed at, for a scene's report. */
#include <stdbool.h>

#include "base/freed.h"
#include "base/text.h"
#include "pack/pack.h"
#include "report/scene_report.h"

enum { NAMED = 3 };

/* Prints e.g. "bent by material 1 "glass" and 2 more"; returns their number. */
static uint32_t print_casters(const ec_scene *scene, const bool *casts, bool bent, const char *before, FILE *to)
{
    uint32_t count = 0;
    for (uint32_t m = 0; m < scene->material_count; m++) {
        const ec_material *material = &scene->materials[m];
        if (!casts[m] || ec_material_bends(material) != bent || count++ >= NAMED) continue;
        fprintf(to, "%s%u", count == 1 ? before : ", ", m);
        if (material->name) fprintf(to, " \"%.*s\"", EC_CUT(material->name, 36));
    }
    if (count > NAMED) fprintf(to, " and %u more", count - NAMED);
    return count;
}

void ec_caustics_text(const ec_scene_report *report, FILE *to)
{
    EC_FREED bool *casts = ec_scene_casters(report->scene);
    if (!casts) return;
    const uint32_t bent = print_casters(report->scene, casts, true, "caustics    light is bent by material ", to);
    const uint32_t mirrored = print_casters(report->scene, casts, false, bent ? "; mirrored by material " : "caustics    light is mirrored by material ", to);
    if (!bent && !mirrored) fputs("caustics    none: no surface bends light, or mirrors most of it, within a narrow lobe\n", to);
    else if (!report->has_light && !report->takes_studio) fputs("\n            but there is none\n", to);
    else fputs("\n            render looks first whether light paths pay (--light-paths)\n", to);
}

void ec_caustics_json(const ec_scene_report *report, cJSON *root)
{
    const ec_scene *scene = report->scene;
    EC_FREED bool *casts = ec_scene_casters(scene);
    cJSON *list = cJSON_AddArrayToObject(root, "caustics");
    for (uint32_t m = 0; casts && m < scene->material_count; m++)
        if (casts[m])
            EC_JSON(ec_json_object(list, NULL), EC_WHOLE("material", m), EC_STRING("name", scene->materials[m].name),
                    EC_STRING("light", ec_material_bends(&scene->materials[m]) ? "bent" : "mirrored"));
}
