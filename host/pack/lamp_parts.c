/* Begins with the lamps, and repeatedly cuts in four the triangle with the largest unevenness times light, until little is left to gain. */
#include "pack/lamp_parts.h"

#include <math.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/brightness.h"

#define PI 3.14159265358979323846

typedef struct part {
    double b[2], size;  /* as in lamp_part of the kernels */
    double weight;      /* area times pi, doubled if two-sided */
    ec_bright bright;
    uint32_t lamp;      /* index in the list of lights */
    uint32_t children;  /* index of the first of four; 0: none */
    bool is_fine;       /* not to be cut further */
} part;

typedef struct cutter {
    const ec_scene *scene;
    const ec_light_data *lights;
    const ec_brightness *of_material; /* without an image if the material has no texture */
    part *parts;
    uint32_t count, lamps;            /* the lamps are the first parts */
    uint32_t *heap, waiting;          /* heap with the least even part at 0 */
} cutter;

/* Returns the unevenness of a part: root mean square minus mean, times its weight. */
static double excess(const part *p) { return p->weight * (sqrt((double)p->bright.square) - (double)p->bright.mean); }

static double within_reach(double u) { return isfinite(u) ? fmin(fmax(u, -1e6), 1e6) : 0; }

/* Computes where a corner of the lamp lies on its picture. */
static void picture_place(const ec_scene *scene, const ec_texture_use *use, uint32_t vertex, double place[2])
{
    const float *uv = scene->uv[use->uv_set ? 1 : 0], *m = use->transform;
    const double u = uv ? within_reach((double)uv[2 * (size_t)vertex]) : 0, v = uv ? within_reach((double)uv[2 * (size_t)vertex + 1]) : 0;
    place[0] = within_reach((double)m[0] * u + (double)m[1] * v + (double)m[2]);
    place[1] = within_reach((double)m[3] * u + (double)m[4] * v + (double)m[5]);
}

static void look(const cutter *c, part *p)
{
    const uint32_t prim = c->lights[p->lamp].prim, material = c->scene->triangle_material[prim];
    double whole[3][2], corners[3][2], texels;
    for (int i = 0; i < 3; i++)
        picture_place(c->scene, &c->scene->materials[material].textures[EC_SLOT_EMISSION], c->scene->indices[3 * (size_t)prim + (size_t)i], whole[i]);
    for (int k = 0; k < 2; k++) {
        const double e = whole[1][k] - whole[0][k], f = whole[2][k] - whole[0][k], first = whole[0][k] + p->b[0] * e + p->b[1] * f;
        corners[0][k] = first, corners[1][k] = first + p->size * e, corners[2][k] = first + p->size * f;
    }
    p->bright = ec_brightness_over(&c->of_material[material], corners, &texels);
    p->is_fine = texels < EC_LAMP_TEXELS || fabs(p->size) <= ldexp(1, -EC_LAMP_DEPTH);
}

static void push(cutter *c, uint32_t one)
{
    uint32_t at = c->waiting++;
    for (; at > 0 && excess(&c->parts[c->heap[(at - 1) / 2]]) < excess(&c->parts[one]); at = (at - 1) / 2) c->heap[at] = c->heap[(at - 1) / 2];
    c->heap[at] = one;
}

static uint32_t pop(cutter *c)
{
    const uint32_t top = c->heap[0], last = c->heap[--c->waiting];
    uint32_t at = 0;
    for (uint32_t child; (child = 2 * at + 1) < c->waiting; at = child) {
        if (child + 1 < c->waiting && excess(&c->parts[c->heap[child + 1]]) > excess(&c->parts[c->heap[child]])) child++;
        if (excess(&c->parts[c->heap[child]]) <= excess(&c->parts[last])) break;
        c->heap[at] = c->heap[child];
    }
    c->heap[at] = last;
    return top;
}

static void cut(cutter *c, uint32_t one)
{
    part *p = &c->parts[one];
    p->children = c->count;
    for (int k = 0; k < 4; k++) {
        part *child = &c->parts[c->count++];
        *child = (part){.b = {p->b[0] + (k & 1 ? p->size / 2 : 0), p->b[1] + (k & 2 ? p->size / 2 : 0)}, .size = k == 3 ? -p->size / 2 : p->size / 2,
                        .weight = p->weight / 4, .lamp = p->lamp};
        look(c, child);
    }
}

static void cut_all(cutter *c)
{
    double light = 0, uneven = 0;
    for (uint32_t i = 0; i < c->lamps; i++) {
        light += c->parts[i].weight * (double)c->parts[i].bright.mean, uneven += excess(&c->parts[i]);
        push(c, i);
    }
    for (uint32_t cuts = 0; c->waiting && cuts < EC_LAMP_CUTS && uneven > EC_LAMP_EXCESS * light;) {
        const uint32_t one = pop(c);
        uneven -= excess(&c->parts[one]);
        light -= c->parts[one].weight * (double)c->parts[one].bright.mean;
        if (c->parts[one].is_fine) { /* it stays as it is */
            light += c->parts[one].weight * (double)c->parts[one].bright.mean;
            continue;
        }
        cut(c, one);
        cuts++;
        for (uint32_t child = c->parts[one].children; child < c->count; child++) {
            light += c->parts[child].weight * (double)c->parts[child].bright.mean, uneven += excess(&c->parts[child]);
            push(c, child);
        }
    }
}

/* Sums up the children of each part, and joins those whose cut gained nothing. Children stand behind their parents. */
static void sum_up(cutter *c)
{
    for (uint32_t i = c->count; i-- > 0;) {
        part *p = &c->parts[i];
        double mean = 0, square = 0, root = 0;
        if (!p->children) continue;
        for (uint32_t k = 0; k < 4; k++) {
            const ec_bright one = c->parts[p->children + k].bright;
            mean += (double)one.mean / 4, square += (double)one.square / 4;
            root += sqrt((double)one.square) / 4;
        }
        p->bright = (ec_bright){(float)mean, (float)square};
        bool is_even = true;
        for (uint32_t k = 0; k < 4; k++) is_even &= !c->parts[p->children + k].children;
        if (is_even && sqrt(square) <= EC_LAMP_EVEN * root) p->children = 0;
    }
}

/* Returns the brightness of its parts by their root mean squares. */
static double sampled_light(const cutter *c, uint32_t one)
{
    const part *p = &c->parts[one];
    double sum = 0;
    for (uint32_t k = 0; p->children && k < 4; k++) sum += sampled_light(c, p->children + k);
    return p->children ? sum : p->weight * sqrt((double)p->bright.square);
}

/* Divides the numbers among a part's descendants in order, by their share of `all`; *sum: the light before them. */
static uint32_t number_of(double sum, double all) { return (uint32_t)(fmin(sum / all, 1) * EC_LAMP_PARTS_NUMBERS); }

static void share_out(const cutter *c, uint32_t one, double all, double *sum, const uint32_t *node_of, ec_lamp_node *nodes)
{
    const part *p = &c->parts[one];
    if (!p->children) {
        *sum += p->weight * sqrt((double)p->bright.square);
        return;
    }
    for (uint32_t k = 0; k < 4; k++) {
        if (k) nodes[node_of[one]].first[k - 1] = number_of(*sum, all);
        share_out(c, p->children + k, all, sum, node_of, nodes);
    }
}

/* Assigns places to a lamp's nodes, the children of one node side by side; node_of and queue are scratch, by part. */
static void place_nodes(const cutter *c, uint32_t lamp, uint32_t *node_of, uint32_t *queue, ec_pack *pack)
{
    uint32_t end = 0;
    node_of[lamp] = pack->lamp_node_count++;
    queue[end++] = lamp;
    for (uint32_t at = 0; at < end; at++) {
        const part *p = &c->parts[queue[at]];
        uint32_t link = pack->lamp_node_count << 4;
        for (uint32_t k = 0; k < 4; k++) {
            if (!c->parts[p->children + k].children) continue;
            link |= 1u << k;
            node_of[p->children + k] = pack->lamp_node_count++;
            queue[end++] = p->children + k;
        }
        pack->lamp_nodes[node_of[queue[at]]] = (ec_lamp_node){.link = link};
    }
}

static bool is_worth_it(const part *p)
{
    return p->children && p->bright.mean > 0 && sqrt((double)p->bright.square) >= EC_LAMP_UNEVEN * (double)p->bright.mean;
}

static ec_result write_nodes(const cutter *c, ec_pack *pack, ec_light_data *lights, double *power, ec_error *err)
{
    EC_FREED uint32_t *node_of = malloc(c->count * sizeof *node_of);
    EC_FREED uint32_t *queue = malloc(c->count * sizeof *queue);
    pack->lamp_nodes = malloc((c->count / 4 + (size_t)2) * sizeof *pack->lamp_nodes);
    if (!node_of || !queue || !pack->lamp_nodes) return ec_fail(err, "out of memory for %u parts of lamps", c->count);
    for (uint32_t i = 0; i < c->lamps; i++) {
        const part *p = &c->parts[i];
        if (!is_worth_it(p)) continue;
        if (!pack->lamp_node_count) pack->lamp_nodes[pack->lamp_node_count++] = (ec_lamp_node){.link = 0};
        double sum = 0;
        place_nodes(c, i, node_of, queue, pack);
        share_out(c, i, sampled_light(c, i), &sum, node_of, pack->lamp_nodes);
        lights[p->lamp].kind |= node_of[i] << EC_LIGHT_PARTS;
        pack->prims[lights[p->lamp].prim].flags |= node_of[i] << EC_PRIM_PARTS;
        power[p->lamp] = p->weight * (double)p->bright.mean;
    }
    if (!pack->lamp_node_count) free(pack->lamp_nodes), pack->lamp_nodes = NULL;
    return EC_OK;
}

static double area(const ec_light_data *l)
{
    double n[3];
    ec_triangle_normal(l->a, l->b, l->c, n);
    return 0.5 * sqrt(n[2] * n[2] + n[0] * n[0] + n[1] * n[1]); /* added in this order, as the last bit decides which lamp is cut first */
}

static bool is_textured(const ec_light_data *l) { return (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE && (l->kind & EC_LIGHT_TEXTURED); }

static part whole_lamp(const ec_light_data *lights, uint32_t lamp)
{
    const double sides = lights[lamp].kind & EC_LIGHT_TWO_SIDED ? 2 : 1;
    return (part){.size = 1, .lamp = lamp, .weight = PI * area(&lights[lamp]) * sides};
}

static ec_result look_at_textures(const ec_scene *scene, const ec_light_data *lights, uint32_t count, ec_brightness *of_material, ec_error *err)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t m = is_textured(&lights[i]) ? scene->triangle_material[lights[i].prim] : 0;
        if (is_textured(&lights[i]) && !of_material[m].image) EC_TRY(ec_brightness_make(scene, &scene->materials[m], &of_material[m], err));
    }
    return EC_OK;
}

ec_result ec_lamp_parts_find(const ec_scene *scene, ec_pack *pack, ec_light_data *lights, double *power, uint32_t count, const bool *may_cut,
                             ec_error *err)
{
    uint32_t textured = 0;
    for (uint32_t i = 0; i < count; i++) textured += is_textured(&lights[i]) && may_cut[lights[i].prim];
    if (!textured) return EC_OK;
    const size_t most = textured + 4 * (size_t)EC_LAMP_CUTS;
    ec_brightness *of_material = calloc(scene->material_count, sizeof *of_material);
    cutter c = {.scene = scene, .lights = lights, .of_material = of_material, .lamps = textured, .parts = malloc(most * sizeof *c.parts),
                .heap = malloc(most * sizeof *c.heap)};
    ec_result result = of_material && c.parts && c.heap ? EC_OK : ec_fail(err, "out of memory for the parts of %u lamps", textured);
    if (result == EC_OK) result = look_at_textures(scene, lights, count, of_material, err);
    for (uint32_t i = 0; result == EC_OK && i < count; i++)
        if (is_textured(&lights[i]) && may_cut[lights[i].prim]) c.parts[c.count++] = whole_lamp(lights, i);
    if (result == EC_OK) {
#pragma omp parallel for if (textured > 256)
        for (uint32_t i = 0; i < textured; i++) look(&c, &c.parts[i]);
        cut_all(&c);
        sum_up(&c);
        result = write_nodes(&c, pack, lights, power, err);
    }
    for (uint32_t m = 0; of_material && m < scene->material_count; m++) ec_brightness_free(&of_material[m]);
    free(of_material);
    free(c.parts);
    free(c.heap);
    return result;
}
