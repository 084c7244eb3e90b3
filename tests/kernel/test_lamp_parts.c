/* tiers: quick, long */
/* A lamp in parts, as kernels use them: numbers choose each part as often as its share says, rescaled numbers are uniform, a point finds
 * the part that chose it, a sample's density is the one found from its direction, and densities integrate to 1 from near and far. */
#include "gltf/reader.h"
#include "kernel/chi2.h"
#include "pack/pack.h"
#include "support/texel_lamp.h"

#define NUMBERS (4 * SAMPLES)
static uint32_t numbers[NUMBERS], first_numbers[NUMBERS];
static float first_out[2 * SAMPLES];

static ec_pack pack_lamp(void)
{
    gltf_writer *w = gltf_new();
    ec_scene *scene;
    ec_pack pack = {0};
    ec_error err = {0};
    texel_lamp_add(w, "kernel-parts", -1, 30, 255, 10); /* the texel has a thirtieth of the light */
    CHECK_OK(ec_scene_load(gltf_write(w, "kernel-parts"), &scene, NULL, &err), err);
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    ec_scene_free(scene);
    free(w);
    return pack;
}

/* Counts by the parts' first numbers, which are in order in the table; the last entry is the whole. */
static void check_choices(cl_program program, uint32_t width, const ec_pack *pack, uint32_t node)
{
    enum { CELLS = 4096 };
    static double expected[CELLS];
    static uint32_t count[CELLS], firsts[CELLS];
    uint32_t cells = 0, tenths[10] = {0}, other = 0;
    const double even = SAMPLES / 10.0, tenth[10] = {even, even, even, even, even, even, even, even, even, even};
    if (!KERNEL_CALL(&cl, program, "choices", samples / width, SCALAR(samples), SCALAR(seed),
                     IN((float *)pack->lamp_nodes, 4 * pack->lamp_node_count), SCALAR(node), OUT(numbers, NUMBERS), OUT(out, 2 * SAMPLES)))
        return;
    if (width == 1) memcpy(first_numbers, numbers, sizeof numbers), memcpy(first_out, out, sizeof first_out);
    const bool is_same = !memcmp(first_numbers, numbers, sizeof numbers) && !memcmp(first_out, out, sizeof first_out);
    CHECK_MSG(is_same, "other bits with %u lanes", width);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const bool is_whole = out[SAMPLES + i] == 1;
        const uint32_t first = is_whole ? EC_LAMP_PARTS_NUMBERS : numbers[i], share = is_whole ? 0u - EC_LAMP_PARTS_NUMBERS : numbers[SAMPLES + i];
        uint32_t k = 0;
        while (k < cells && firsts[k] != first) k++;
        if (k == cells && cells < CELLS) firsts[cells] = first, expected[cells] = share * 0x1p-32 * SAMPLES, count[cells++] = 0;
        count[k < CELLS ? k : 0]++;
        tenths[(int)(out[i] * 10)]++;
        other += numbers[i] != numbers[2 * SAMPLES + i] || numbers[SAMPLES + i] != numbers[3 * SAMPLES + i];
    }
    CHECK_MSG(!other, "%u points are in other parts than those that they were chosen by", other);
    printf("%u parts and the whole\n", cells - 1);
    CHECK(cells > 20);
    check_chi2("parts", expected, count, cells);
    check_chi2("what is left of the numbers", tenth, tenths, 10);
}

static void check_densities(cl_program program, uint32_t width, const ec_pack *pack, const ec_light_data *l, double height)
{
    float corners[12], p[3] = {0.14f, (float)(1 - height), -0.33f};
    const uint32_t node = l->kind >> EC_LIGHT_PARTS;
    memcpy(corners, l->a, sizeof l->a), memcpy(corners + 3, l->b, sizeof l->b), memcpy(corners + 6, l->c, sizeof l->c);
    for (int k = 0; k < 3; k++) corners[9 + k] = p[k] + (k == 1 ? l->a[1] - 1 : 0); /* the frame's origin is the scene's centre */
    if (!KERNEL_CALL(&cl, program, "densities", samples / width, SCALAR(samples), SCALAR(seed),
                     IN((float *)pack->lamp_nodes, 4 * pack->lamp_node_count), SCALAR(node), IN(corners, 12), OUT(out, 3 * SAMPLES)))
        return;
    double sum = 0, squares = 0;
    uint32_t off = 0, invalid = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        invalid += !(out[i] > 0 && isfinite(out[i]));
        off += out[i] > 0 && !(fabs(out[SAMPLES + i] / out[i] - 1) < 1e-3f);
        sum += out[2 * SAMPLES + i];
        squares += (double)out[2 * SAMPLES + i] * out[2 * SAMPLES + i];
    }
    const double mean = sum / SAMPLES, error = sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
    printf("%g below: density integrates to %.4f +- %.4f; %u of %u found otherwise\n", height, mean, error, off, SAMPLES);
    CHECK_MSG(off < SAMPLES / 500, "%g below: %u densities are found otherwise", height, off); /* after rounding, a point may be in the next part */
    CHECK_MSG(invalid < SAMPLES / 1000, "%g below: %u samples are invalid", height, invalid);
    CHECK_MSG(fabs(mean - 1) < 4 * error && error < 0.1, "%g below: the density integrates to %g +- %g", height, mean, error);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    ec_pack pack = pack_lamp();
    const int widths = kernel_widths(&cl);
    const ec_light_data *l = &pack.lights[0];
    if (!(l->kind >> EC_LIGHT_PARTS)) l++;
    CHECK(pack.light_count == 2 && l->kind >> EC_LIGHT_PARTS);
    for (int i = 0; i < widths && !test_failures; i++) {
        cl_program program = kernel_build(&cl, "lamp_parts", lane_widths[i], "-DFEATURES=(EC_FEATURE_AREA_LIGHTS|EC_FEATURE_LAMP_PARTS)");
        if (!program) break;
        check_choices(program, (uint32_t)lane_widths[i], &pack, l->kind >> EC_LIGHT_PARTS);
        static const double heights[] = {3, 0.3, 0.02};
        for (int h = 0; h < 3; h++) check_densities(program, (uint32_t)lane_widths[i], &pack, l, heights[h]);
        clReleaseProgram(program);
    }
    ec_pack_free(&pack);
    ec_cl_close(&cl);
    TEST_END();
}
