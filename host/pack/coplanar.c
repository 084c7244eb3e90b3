/* Tests pairs whose boxes touch, and writes a list of rivals for each triangle that has some. */
#include "pack/coplanar.h"

#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/met_prims.h"
#include "pack/near_pairs.h"

#define APART 0x1p-19       /* relative to the largest coordinate: 16 to 32 ulps of it, within which rounding decides nothing */
#define WIDE 0x1p-17        /* likewise: triangles that overlap less only touch */
enum { PAIRS_MOST = 64, PAIRS_FREE = 100000 }; /* limits of coplanar pairs: per triangle, and in addition for the scene */

typedef struct rival {
    uint32_t of, prim;
    bool alike; /* both face the same way */
    int rank;
} rival;

typedef struct finder {
    const ec_prim *prims; /* by id */
    uint32_t prim_count;
    const ec_material *materials;
    const ec_motion *motion; /* NULL: nothing moves */
    double apart, wide;
    uint64_t looks, looks_most; /* number of pairs in one plane that were tested */
    size_t count, room;
    rival *rivals;
    bool failed;
} finder;

typedef double corners[3][3];

static void subtract(const double a[3], const double b[3], double r[3])
{
    for (int k = 0; k < 3; k++) r[k] = a[k] - b[k];
}

static void corners_of(const ec_prim *p, corners c)
{
    for (int k = 0; k < 3; k++) c[0][k] = p->v0[k], c[1][k] = p->v1[k], c[2][k] = p->v2[k];
}

/* Computes twice the area times the unit normal. */
static void normal_of(corners c, double n[3])
{
    double a[3], b[3];
    subtract(c[1], c[0], a);
    subtract(c[2], c[0], b);
    ec_cross(a, b, n);
}

/* Tells whether all corners of b lie in the plane of a. */
static bool lies_in(corners a, corners b, double apart)
{
    double n[3];
    normal_of(a, n);
    const double most = apart * apart * ec_dot(n, n);
    for (int i = 2; i >= 0; i--) {
        double d[3];
        subtract(b[i], a[0], d);
        double off = ec_dot(n, d);
        if (!(off * off <= most)) return false;
    }
    return true;
}

/* Tests both planes: the larger triangle's is more precise in general, but where they only overlap the other one may be exact. */
static bool in_one_plane(corners a, corners b, double apart) { return lies_in(a, b, apart) || lies_in(b, a, apart); }

static void extent(corners c, const double axis[3], double *least, double *most)
{
    *least = *most = ec_dot(c[0], axis);
    for (int i = 1; i < 3; i++) {
        double x = ec_dot(c[i], axis);
        *least = fmin(*least, x);
        *most = fmax(*most, x);
    }
}

/* Tells whether they overlap by more than `wide` along all axes in the plane (separating axes). */
static bool overlap(corners a, corners b, double wide)
{
    double n[3], m[3];
    normal_of(a, n);
    normal_of(b, m);
    const double *up = ec_dot(n, n) > ec_dot(m, m) ? n : m;
    for (int e = 0; e < 6; e++) {
        double(*c)[3] = e < 3 ? a : b, edge[3], axis[3], a0, a1, b0, b1;
        subtract(c[(e + 1) % 3], c[e % 3], edge);
        ec_cross(edge, up, axis);
        extent(a, axis, &a0, &a1);
        extent(b, axis, &b0, &b1);
        if (!(fmin(a1, b1) - fmax(a0, b0) > wide * sqrt(ec_dot(axis, axis)))) return false;
    }
    return true;
}

/* Gets a triangle's corners, at a key if it moves. */
static void corners_at(const finder *f, uint32_t prim, uint32_t key, const uint32_t *indices, corners c)
{
    const size_t keys = f->motion->segments + 1;
    if (prim >= f->motion->triangle_count) corners_of(&f->prims[prim], c);
    else
        for (int i = 0; i < 9; i++) c[i / 3][i % 3] = f->motion->positions[3 * (indices[3 * (size_t)prim + i / 3] * keys + key) + i % 3];
}

/* Ranks surfaces by precedence: those with coverage were laid on those without; those that transmit light are seen through. */
static int rank_of(const finder *f, uint32_t prim)
{
    const ec_prim *p = &f->prims[prim];
    const ec_material *m = &f->materials[p->material];
    return (p->flags & EC_PRIM_PANE) || ec_refracts(m) || ec_bounds(m) ? 2 : p->flags & EC_PRIM_ALPHA ? 0 : 1;
}

/* Adds a rival. If both face the same way, a triangle lists only those that precede it. */
static void add(finder *f, uint32_t of, uint32_t prim, bool alike)
{
    const int own = rank_of(f, of), rank = rank_of(f, prim);
    if (f->failed || (alike && (rank > own || (rank == own && prim > of)))) return;
    if (f->count == f->room) {
        size_t room = f->room ? 2 * f->room : 64;
        rival *more = realloc(f->rivals, room * sizeof *more);
        f->failed = !more;
        if (!more) return;
        f->rivals = more, f->room = room;
    }
    f->rivals[f->count++] = (rival){of, prim, alike, rank};
}

/* Visits a pair, in several threads at once; the result is sorted later. Equal triangles are skipped, as rays meet the first one anyway. */
static bool look(void *user, uint32_t a, uint32_t b)
{
    finder *f = user;
    corners ca, cb;
    double n[3], m[3];
    uint64_t looks;
    corners_of(&f->prims[a], ca);
    corners_of(&f->prims[b], cb);
    if (!in_one_plane(ca, cb, f->apart)) return true;
#pragma omp atomic capture
    looks = ++f->looks;
    if (looks > f->looks_most) return false;
    bool equal = !memcmp(ca, cb, sizeof ca) && rank_of(f, a) == rank_of(f, b);
    if (equal || !overlap(ca, cb, f->wide)) return true;
    normal_of(ca, n);
    normal_of(cb, m);
    const bool alike = ec_dot(n, m) > 0;
#pragma omp critical(coplanar)
    {
        add(f, a, b, alike);
        add(f, b, a, alike);
    }
    return true;
}

static bool stay_together(const finder *f, const rival *r, const uint32_t *indices)
{
    if (!f->motion || (r->of >= f->motion->triangle_count && r->prim >= f->motion->triangle_count)) return true;
    for (uint32_t key = 0; key <= f->motion->segments; key++) {
        corners a, b;
        corners_at(f, r->of, key, indices, a);
        corners_at(f, r->prim, key, indices, b);
        if (!in_one_plane(a, b, f->apart)) return false;
    }
    return true;
}

static int by_rank(const void *a, const void *b)
{
    const rival *x = a, *y = b;
    if (x->of != y->of) return x->of < y->of ? -1 : 1;
    if (x->alike != y->alike) return x->alike - y->alike;
    if (x->rank != y->rank) return x->rank - y->rank;
    return x->prim < y->prim ? -1 : x->prim > y->prim;
}

/* Writes the lists in the format of kernels/lib/coplanar.h. */
static ec_result write_lists(const finder *f, ec_pack *pack, ec_error *err)
{
    const uint64_t words = f->prim_count + 3 * (uint64_t)f->count;
    if (words > UINT32_MAX) return ec_fail(err, "%zu pairs of faces in one plane are more than can be numbered", f->count);
    pack->coplanar = calloc(words, sizeof *pack->coplanar);
    if (!pack->coplanar) return ec_fail(err, "out of memory for %zu pairs of faces in one plane", f->count);
    uint32_t at = f->prim_count;
    for (size_t i = 0; i < f->count; i++) {
        const rival *r = &f->rivals[i];
        if (!pack->coplanar[r->of]) pack->coplanar[r->of] = at, at += 2;
        pack->coplanar[pack->coplanar[r->of] + r->alike]++;
        pack->coplanar[at++] = r->prim;
    }
    pack->coplanar_words = at;
    return EC_OK;
}

/* Tells whether the scene has a single opaque material that looks alike everywhere, so that it does not matter which of two faces is met. */
static bool is_plain(const ec_scene *s)
{
    const ec_material *m = s->triangle_count ? &s->materials[s->triangle_material[0]] : NULL;
    bool plain = m && !s->normals && !s->tangents && !s->colors && m->alpha_mode == EC_ALPHA_OPAQUE && !(m->transmission > 0) && !(m->diffuse_transmission > 0);
    for (int k = 0; k < EC_SLOT_COUNT && plain; k++) plain = m->textures[k].texture < 0;
    for (int k = 0; k < 3 && plain; k++) plain = !(m->emission[k] > 0);
    for (uint32_t t = 1; t < s->triangle_count && plain; t++) plain = s->triangle_material[t] == s->triangle_material[0];
    return plain;
}

/* Writes lists of the pairs that stay together while they move. */
static ec_result settle(finder *f, const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    size_t kept = 0;
    for (size_t i = 0; i < f->count; i++)
        if (stay_together(f, &f->rivals[i], scene->indices)) f->rivals[kept++] = f->rivals[i];
    f->count = kept;
    if (!f->count) return EC_OK;
    qsort(f->rivals, f->count, sizeof *f->rivals, by_rank);
    EC_TRY(write_lists(f, pack, err));
    ec_effects_call(&pack->effects, EC_FEATURE_COPLANAR, "triangle %u lies on triangle %u in one plane", f->rivals[0].of, f->rivals[0].prim);
    return EC_OK;
}

ec_result ec_pack_coplanar(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    ec_prim *met;
    finder f = {.materials = scene->materials, .motion = scene->motion.segments ? &scene->motion : NULL, .apart = APART * (double)pack->scene_max,
                .wide = WIDE * (double)pack->scene_max};
    if (is_plain(scene)) return EC_OK;
    EC_TRY(ec_pack_met_prims(scene, pack, &met, &f.prim_count, err));
    if (!met) return EC_OK;
    f.prims = met;
    f.looks_most = (uint64_t)f.prim_count * PAIRS_MOST + PAIRS_FREE;
    ec_result result = ec_near_pairs(f.prims, f.prim_count, (float)f.apart, look, &f, err);
    if (f.failed) result = ec_fail(err, "out of memory for %zu pairs of faces in one plane", f.count);
    if (result == EC_OK && f.looks <= f.looks_most) result = settle(&f, scene, pack, err); /* otherwise too many overlap, and rounding decides */
    free(f.rivals);
    if (met != pack->prims) free(met);
    return result;
}
