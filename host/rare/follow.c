#include "rare/follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"

#define STEP 2e-6 /* of the scene's radius: rays go on so far behind a pane */
enum { PAGE = 256 };  /* triangles that are read at once */
enum { PANES = 8 };   /* in the way of a ray, at most */

ec_result ec_rare_follower_open(const ec_rare_lights *lights, ec_pipeline *p, ec_rare_follower *f, ec_error *err)
{
    *f = (ec_rare_follower){.lights = lights, .p = p, .pages = calloc(lights->stored_count / PAGE + (size_t)1, sizeof *f->pages)};
    for (uint32_t m = 0; m < lights->material_count; m++) f->has_panes |= lights->straight[m] > 0;
    return f->pages ? EC_OK : ec_fail(err, "out of memory for %u triangles", lights->stored_count);
}

void ec_rare_follower_close(ec_rare_follower *f)
{
    for (uint32_t i = 0; f->pages && i <= f->lights->stored_count / PAGE; i++) free(f->pages[i]);
    free(f->pages);
    free(f->on);
    free(f->which);
    *f = (ec_rare_follower){0};
}

void ec_rare_ray(const float point[3], const float direction[3], double sign, double back, ec_chain *ray)
{
    *ray = (ec_chain){.prim = EC_NO_ID, .beta = 1};
    for (int k = 0; k < 3; k++) {
        ray->direction[k] = (float)(sign * direction[k]);
        ray->origin[k] = (float)(point[k] - back * ray->direction[k]);
    }
}

/* Reads a triangle as it is stored; the pages are freed as a whole. */
static ec_result read_stored(ec_rare_follower *f, uint32_t stored, const ec_prim **at, ec_error *err)
{
    ec_prim **page = &f->pages[stored / PAGE];
    const uint32_t first = stored / PAGE * PAGE, left = f->lights->stored_count - first, count = left < PAGE ? left : PAGE;
    if (!*page) {
        *page = malloc(count * sizeof **page);
        if (!*page) return ec_fail(err, "out of memory for %u triangles", count);
        EC_TRY(ec_buffer_read(f->p->cl, f->p->buffers[EC_ARG_PRIMS], (uint64_t)first * sizeof **page, count * sizeof **page, *page, err));
    }
    *at = *page + stored % PAGE;
    return EC_OK;
}

/* Sets a corner and the unit normal of a triangle in the world; zero where it has none. */
static ec_result plane_of(ec_rare_follower *f, uint32_t id, float corner[3], double normal[3], ec_error *err)
{
    const ec_placed *placed;
    const ec_prim *stored = NULL;
    float v[3][3];
    EC_TRY(read_stored(f, ec_rare_stored_of(f->lights, id, &placed), &stored, err));
    const float *corners[3] = {stored->v0, stored->v1, stored->v2};
    for (int k = 0; k < 3; k++)
        if (placed) ec_placed_point(placed, corners[k], v[k]);
        else memcpy(v[k], corners[k], sizeof v[k]);
    memcpy(corner, v[0], sizeof v[0]);
    ec_triangle_normal(v[0], v[1], v[2], normal);
    if (!ec_normalize(normal)) memset(normal, 0, 3 * sizeof *normal);
    return EC_OK;
}

ec_result ec_rare_normal_of(ec_rare_follower *f, uint32_t id, double normal[3], ec_error *err)
{
    float corner[3];
    return plane_of(f, id, corner, normal, err);
}

ec_result ec_rare_land(ec_rare_follower *f, const ec_chain *ray, ec_rare_landing *at, ec_error *err)
{
    double n[3], along = 0, way = 0;
    float corner[3];
    EC_TRY(plane_of(f, ray->hit, corner, n, err));
    for (int k = 0; k < 3; k++) along += n[k] * ray->direction[k], way += n[k] * ((double)corner[k] - ray->origin[k]);
    at->distance = way / along;
    at->cosine = at->distance > 0 && isfinite(at->distance) ? fabs(along) : 0;
    for (int k = 0; k < 3; k++) {
        at->point[k] = (float)(ray->origin[k] + at->distance * ray->direction[k]);
        at->normal[k] = (float)(along > 0 ? -n[k] : n[k]);
    }
    return EC_OK;
}

/* Keeps rays that have met panes in `on`, on the other side of these. which: of rays[i], NULL: i. */
static ec_result pass_panes(ec_rare_follower *f, const ec_chain *rays, const uint32_t *which, uint32_t count, uint32_t *passed, ec_error *err)
{
    *passed = 0;
    for (uint32_t i = 0; i < count; i++) {
        ec_rare_landing at;
        const float straight = rays[i].hit == EC_NO_ID ? 0 : f->lights->straight[ec_rare_material_of(f->lights, rays[i].hit)];
        if (!(straight > 0)) continue;
        EC_TRY(ec_rare_land(f, &rays[i], &at, err));
        if (!(at.cosine > 0)) continue;
        ec_chain ray = rays[i];
        for (int k = 0; k < 3; k++) ray.origin[k] = (float)(ray.origin[k] + (at.distance + STEP * f->lights->radius) * ray.direction[k]);
        ray.prim = ray.hit;
        ray.beta *= straight;
        f->which[*passed] = which ? which[i] : i;
        f->on[(*passed)++] = ray;
    }
    return EC_OK;
}

static ec_result make_room(ec_rare_follower *f, uint32_t count, ec_error *err)
{
    if (!f->has_panes || count <= f->room) return EC_OK;
    free(f->on);
    free(f->which);
    f->on = malloc(count * sizeof *f->on);
    f->which = malloc(count * sizeof *f->which);
    f->room = f->on && f->which ? count : 0;
    return f->room ? EC_OK : ec_fail(err, "out of memory for %u rays", count);
}

ec_result ec_rare_follow(ec_rare_follower *f, ec_chain *rays, uint32_t count, ec_error *err)
{
    uint32_t passed = 0;
    if (!count) return EC_OK;
    EC_TRY(make_room(f, count, err));
    EC_TRY(ec_chains_meet(f->p, rays, count, err));
    if (f->has_panes) EC_TRY(pass_panes(f, rays, NULL, count, &passed, err));
    for (int n = 0; n < PANES && passed; n++) {
        EC_TRY(ec_chains_meet(f->p, f->on, passed, err));
        for (uint32_t i = 0; i < passed; i++) rays[f->which[i]] = f->on[i];
        EC_TRY(pass_panes(f, f->on, f->which, passed, &passed, err));
    }
    return EC_OK;
}

ec_result ec_rare_reach(ec_rare_follower *f, ec_chain *rays, uint32_t count, ec_error *err)
{
    for (uint32_t i = 0; i < count; i++) {
        ec_rare_landing at = {.distance = INFINITY};
        if (rays[i].hit != EC_NO_ID) EC_TRY(ec_rare_land(f, &rays[i], &at, err));
        rays[i].reach = (float)at.distance;
    }
    return EC_OK;
}

bool ec_rare_meets(const ec_rare_follower *f, const ec_rare_source *source, const ec_chain *ray)
{
    if (source->type == EC_RARE_LAMP) return ray->hit != EC_NO_ID && ec_rare_material_of(f->lights, ray->hit) == source->material;
    if (source->type == EC_RARE_FAR || ray->hit == EC_NO_ID) return ray->hit == EC_NO_ID;
    return (double)ray->reach * ray->reach > ec_square_between(ray->origin, source->middle);
}
