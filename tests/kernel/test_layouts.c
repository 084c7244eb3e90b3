/* tier: quick */
/* The structs of kernels/shared have the same layout for the device's compiler as for the host's. */
#include <stddef.h>

#include "kernel/kernel_run.h"
#include "kernel/layouts.h"
#include "shared/accel.h"
#include "shared/params.h"
#include "shared/scene_buffers.h"

#define HOST_SIZE(type) {#type, (uint32_t)sizeof(type)},
#define HOST_FIELD(type, field) {#type "." #field, (uint32_t)offsetof(type, field)},
#define HOST_NUMBER(x) {#x, (uint32_t)(x)},
static const struct expected {
    const char *name;
    uint32_t value;
} expected[] = {LAYOUTS(HOST_SIZE, HOST_FIELD, HOST_NUMBER)};
#define COUNT (sizeof expected / sizeof *expected)

static void words_are_those_of_the_structs(void)
{
#define IS_AT(field) CHECK_MSG(EC_WORD_##field * 4 == offsetof(ec_material_data, field), "%s", #field);
#define FIELD(field, floats, value, least, most, slot, channel, effect, has, path) IS_AT(field)
#define FILES(field, floats, value, least, most, slot, channel, effect, has, path)
#define WORD(type, field) IS_AT(field)
    EC_MATERIAL_FIELDS(FIELD, FILES, WORD, IS_AT)
    static const int in_fours[] = {EC_WORD_base_color, EC_WORD_emission, EC_WORD_metallic, EC_WORD_f0, EC_WORD_absorption, EC_WORD_ior, EC_WORD_coat,
                                   EC_WORD_sheen, EC_WORD_anisotropy, EC_WORD_transmission_color, EC_WORD_scatter_albedo, EC_WORD_film, EC_WORD_slots};
    for (size_t i = 0; i < sizeof in_fours / sizeof *in_fours; i++) CHECK(in_fours[i] % 4 == 0);
    CHECK(EC_PRIM_WORDS * 4 == sizeof(ec_prim));
    CHECK(EC_MATERIAL_WORDS * 4 == sizeof(ec_material_data));
    CHECK(EC_LIGHT_WORDS * 4 == sizeof(ec_light_data));
    CHECK(sizeof(ec_texture_slot) == 32 && sizeof(ec_texture_data) == 16 && sizeof(ec_distribution_entry) == 8); /* in the unit that kernels use */
    CHECK(offsetof(ec_prim, flags) == 44 && offsetof(ec_prim, light_pdf_a) == 28 && offsetof(ec_prim, material) == 12);
}

int main(void)
{
    ec_cl cl;
    int open = kernel_open(&cl);
    if (open) return open;
    words_are_those_of_the_structs();
    uint32_t device[COUNT + 1];
    memset(device, 0xee, sizeof device);
    cl_program program = kernel_build(&cl, "layouts", 1, NULL);
    if (program && KERNEL_CALL(&cl, program, "layouts", 1, OUT(device, COUNT + 1)))
        for (size_t i = 0; i < COUNT; i++)
            CHECK_MSG(device[i] == expected[i].value, "%s: %u on the device, %u here", expected[i].name, device[i], expected[i].value);
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}
