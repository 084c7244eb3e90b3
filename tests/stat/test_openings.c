/* tier: quick */
/* Predicted light of small lit patches, from path vertices near them. The nearest twelve on the patch's plane and side count, and none on a wall that
 * meets the plane; vertices that the camera sees count separately from others on a path. A sky's patch stands for others, and is met by some of its
 * vertices' samples. */
#include "rare/patches.h"

#include <math.h>

#include "film/rare.h"
#include "rare/lights.h"
#include "support/test.h"

#define PI 3.14159265358979323846
enum { NEAREST = 11, AROUND = 20, PATHS = 1000, SIDE = 64, VERTICES = 2 * (2 * AROUND + 4) }; /* NEAREST: a twelfth one is on the wall */
enum { FLOOR, WALL };

static ec_chain vertices[VERTICES];
static uint32_t vertex_count;

static void add_vertex(const ec_rare_patch *patch, double distance, double height, float up, uint32_t segment, float beta)
{
    vertices[vertex_count++] = (ec_chain){.origin = {patch->point[0] + (float)distance, patch->point[1], patch->point[2] + (float)height},
                                          .direction = {0, 0, up}, .beta = beta, .segment = segment};
}

/* Vertices in no order of distance. Nearer than all of them are one on the other side, one off the plane, and two on a wall. */
static void surround(const ec_rare_patch *patch, double seen, double on_the_way)
{
    add_vertex(patch, 0.5 * seen, 0, -1, 1, 99);
    add_vertex(patch, 0.2 * seen, 0.2 * seen, 1, 2, 99);
    for (uint32_t segment = 1; segment <= 2; segment++) {
        add_vertex(patch, 0.3 * seen, 0, 1, segment, 99);
        vertices[vertex_count - 1].prim = WALL;
    }
    for (int i = 0; i < AROUND; i++) {
        const int k = 1 + 7 * i % AROUND;
        add_vertex(patch, k * seen, 0, 1, 1, (float)k);
        add_vertex(patch, k * on_the_way, 0, 1, 2, (float)(2 * k));
    }
}

/* The kind of light of this amount whose nearest vertices have this spacing. */
static void check_kind(const ec_rare *rare, const ec_rare_patch *patch, double spacing, bool seen)
{
    const double farthest = NEAREST * spacing, there = patch->weight * NEAREST * patch->area / (PI * farthest * farthest) / PATHS;
    const double beta = (seen ? 0.5 : 1) * (NEAREST + 1), luminance = there * beta * patch->irradiance / PI, chance = there * patch->chance;
    uint32_t found = 0;
    for (uint32_t i = 0; i < rare->count; i++) {
        const ec_rare_kind *kind = &rare->kinds[i];
        if (fabs(kind->chance / chance - 1) > 1e-4) continue;
        found++;
        CHECK_MSG(fabs(kind->luminance / luminance - 1) < 1e-4, "spacing %g: luminance %g, expected %g", spacing, kind->luminance, luminance);
        CHECK_MSG(kind->clamped == (seen ? 0 : 1), "spacing %g: clamped %g", spacing, kind->clamped);
        CHECK_MSG(kind->share[0] == 255 && kind->share[1] == (seen && !patch->is_sky ? 0 : 255), "spacing %g: shares %u, %u", spacing, kind->share[0], kind->share[1]);
    }
    CHECK_MSG(found == 1, "spacing %g: %u kinds of chance %g", spacing, found, chance);
}

int main(void)
{
    ec_rare_patch patches[2] = {{.point = {1, 2, 3}, .normal = {0, 0, 1}, .irradiance = 50, .area = 1e-3, .chance = 1, .weight = 1, .light = "sun"},
                                {.point = {101, 2, 3}, .normal = {0, 0, 1}, .irradiance = 7, .area = 2e-3, .chance = 0.1, .weight = 3, .light = "sky",
                                 .is_sky = true}};
    const ec_rare_patches both = {2, patches};
    const ec_rare_lights lights = {.radius = 1, .stored_count = 2};
    ec_prim triangles[] = {[FLOOR] = {.v1 = {1, 0, 0}, .v2 = {0, 1, 0}}, [WALL] = {.v1 = {1, 0, 0}, .v2 = {0, 0, 1}}}, *pages[] = {triangles};
    ec_rare_follower follower = {.lights = &lights, .pages = pages};
    ec_error err = {0};
    ec_rare rare = {.width = SIDE, .height = SIDE};
    surround(&patches[0], 0.1, 0.13);
    surround(&patches[1], 0.17, 0.2);
    const ec_chains paths = {.paths = PATHS, .vertices = vertices, .vertex_count = vertex_count};
    CHECK(vertex_count == VERTICES);
    CHECK(ec_rare_patches_judge(&both, &follower, &paths, &rare, &err) == EC_OK);
    CHECK(rare.count == 4);
    check_kind(&rare, &patches[0], 0.1, true);
    check_kind(&rare, &patches[0], 0.13, false);
    check_kind(&rare, &patches[1], 0.17, true);
    check_kind(&rare, &patches[1], 0.2, false);
    TEST_END();
}
