/* tier: quick */
/* The choice of a device, and the facts about its driver. Uses no device. */
#include "cl/workarounds.h"
#include "device/pipeline.h"
#include "render/render.h"
#include "support/cl_case.h"

/* Returns the index that `id` chooses among the first `count` fake devices, or -1. */
static int chosen(const char *id, uint32_t count, const char **why, ec_error *err)
{
    ec_device_info devices[4];
    uint32_t index = 99;
    fake_devices(devices);
    return ec_device_choose(devices, count, id, &index, why, err) == EC_OK ? (int)index : -1;
}

static void workarounds_go_by_the_driver(void)
{
    ec_cl cl = {.info = {.name = "llvmpipe", .platform_name = "rusticl", .type = CL_DEVICE_TYPE_CPU, .native_float_width = 8}};
    ec_error err = {0};
    uint32_t lanes = 0;
    CHECK(ec_pipeline_lanes(&cl, 0, &lanes, &err) == EC_OK && lanes == 1);
    CHECK(ec_pipeline_lanes(&cl, 1, &lanes, &err) == EC_OK && lanes == 1);
    CHECK(ec_pipeline_lanes(&cl, 4, &lanes, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "--lanes 4 on llvmpipe") && strstr(err.text, "choose 1") && !strchr(err.text, '\n'), "%s", err.text);
    strcpy(cl.info.platform_name, "another"); /* no workaround: what the device states, or what is requested */
    CHECK(ec_pipeline_lanes(&cl, 0, &lanes, &err) == EC_OK && lanes == 8);
    CHECK(ec_pipeline_lanes(&cl, 16, &lanes, &err) == EC_OK && lanes == 16);
    CHECK(!ec_workaround_for(&cl.info));
    ec_device_info devices[4];
    fake_devices(devices);
    const ec_workaround *pocl = ec_workaround_for(&devices[0]);
    CHECK(pocl && pocl->source_only && !pocl->most_lanes && !ec_workaround_for(&devices[2]));
    CHECK(ec_device_rounds(&devices[1]) && !ec_device_rounds(&devices[3])); /* neither says so */
    devices[3].correctly_rounded_divide_sqrt = true;
    CHECK(ec_device_rounds(&devices[3]));
}

/* Forces every row on a device with another driver, where it must have its effect, and none on a device that has a row. */
static void workarounds_can_be_forced(void)
{
    ec_cl cl = {.info = {.name = "GeForce", .platform_name = "NVIDIA CUDA", .type = CL_DEVICE_TYPE_CPU, .native_float_width = 8}};
    ec_error err = {0};
    uint32_t lanes = 0;
    setenv("ECLAT_WORKAROUND", "PoCL", 1);
    const ec_workaround *row = ec_workaround_for(&cl.info);
    CHECK(row && row->source_only && ec_compiles_late(&cl.info) && !ec_device_rounds(&cl.info));
    CHECK(strstr(ec_builtin_options(&cl.info), "-DEC_OWN_BUILTINS"));
    setenv("ECLAT_WORKAROUND", "oclgrind", 1);
    row = ec_workaround_for(&cl.info);
    CHECK(row && row->source_only && row->no_touch && !ec_compiles_late(&cl.info));
    setenv("ECLAT_WORKAROUND", "rusticl", 1);
    CHECK(ec_pipeline_lanes(&cl, 0, &lanes, &err) == EC_OK && lanes == 1 && ec_device_rounds(&cl.info));
    setenv("ECLAT_WORKAROUND", "Intel(R) OpenCL", 1);
    row = ec_workaround_for(&cl.info);
    CHECK(row && !row->source_only && ec_device_rounds(&cl.info));
    strcpy(cl.info.platform_name, "rusticl");
    setenv("ECLAT_WORKAROUND", "none", 1);
    CHECK(!*ec_builtin_options(&cl.info));
    CHECK(!ec_workaround_for(&cl.info) && ec_pipeline_lanes(&cl, 0, &lanes, &err) == EC_OK && lanes == 8);
    CHECK(ec_workaround_check(&err) == EC_OK);
    setenv("ECLAT_WORKAROUND", "nvidia", 1);
    CHECK(ec_workaround_check(&err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "nvidia") && strstr(err.text, "PoCL, Oclgrind, rusticl, Intel(R) OpenCL or none"), "%s", err.text);
    unsetenv("ECLAT_WORKAROUND");
    CHECK(ec_workaround_check(&err) == EC_OK && ec_workaround_for(&cl.info));
}

/* Cards that have the functions use them, unless their row says that the compiler does it; processors do not. */
static void sub_groups_go_by_device_and_row(void)
{
    ec_device_info devices[4];
    fake_devices(devices);
    ec_device_info *card = &devices[3], *processor = &devices[1];
    strcpy(card->platform_name, "another");
    CHECK(!ec_device_joins(card));
    card->subgroup_ballot = processor->subgroup_ballot = true;
    CHECK(ec_device_joins(card) && !ec_device_joins(processor));
    setenv("ECLAT_WORKAROUND", "Intel(R) OpenCL", 1);
    CHECK(!ec_device_joins(card));
    setenv("ECLAT_WORKAROUND", "none", 1);
    CHECK(ec_device_joins(card) && !ec_device_joins(processor));
    unsetenv("ECLAT_WORKAROUND");
    strcpy(card->platform_name, "Intel(R) OpenCL Graphics");
    CHECK(!ec_device_joins(card));
}

/* NVIDIA's threads run in lockstep by 32, AMD's by 32 or 64, Intel's by up to 32. */
static void groups_of_cards_fill_their_threads(void)
{
    ec_device_info devices[4];
    fake_devices(devices);
    CHECK(ec_local_size(&devices[3]) % 64 == 0);
    CHECK(ec_local_size(&devices[0]) == EC_LOCAL_SIZE); /* the targets that PoCL compiles for */
}

/* A word in several names does not choose: "8" is no device of two, and neither is part of another number. */
static void short_numbers_are_no_names(void)
{
    static const char *const none[] = {"8", "16", "309", "090"};
    ec_device_info devices[4];
    ec_error err = {0};
    uint32_t index;
    unsetenv("ECLAT_DEVICE");
    fake_devices(devices);
    strcpy(devices[0].name, "Ryzen 8 16-Core");
    for (int i = 0; i < 4; i++)
        CHECK_MSG(ec_device_choose(devices, 4, none[i], &index, NULL, &err) != EC_OK, "'%s' is taken for %s", none[i],
                  devices[index].name);
}

static void device_rule(void)
{
    const char *why = "";
    ec_error err = {0};
    unsetenv("ECLAT_DEVICE");
    CHECK(chosen(NULL, 4, &why, &err) == 3 && strcmp(why, "first GPU") == 0); /* not the absent one */
    CHECK(chosen(NULL, 3, &why, &err) == 0 && strcmp(why, "first CPU") == 0);
    CHECK(chosen("", 4, NULL, &err) == 3);
    CHECK(chosen("1", 4, &why, &err) == 1 && strstr(why, "--device"));
    CHECK(chosen("geforce", 4, &why, &err) == 3);
    CHECK(chosen("3090", 4, &why, &err) == 1); /* not an index: the first name that contains it */
    CHECK(chosen("pocl", 4, &why, &err) == 0);
    CHECK(chosen("nvidia", 4, &why, &err) == 3); /* names are searched before platforms */
    CHECK(chosen("2", 4, &why, &err) == -1 && strstr(err.text, "not available"));
    CHECK(chosen("radeon", 4, &why, &err) == -1);
    CHECK(strstr(err.text, "--device radeon") && strstr(err.text, "0: pthread-EPYC") && strstr(err.text, "3: NVIDIA"));
    CHECK(chosen("4", 4, &why, &err) == -1);
    CHECK(chosen("1x", 4, &why, &err) == -1);
    static const char *const nothing[] = {"1", "3", "7", " 3", "30", "090", "3.0", " ", "-", ","};
    for (size_t i = 0; i < sizeof nothing / sizeof nothing[0]; i++) /* in a name or the platform's version, by coincidence */
        CHECK_MSG(chosen(nothing[i], 1, &why, &err) == -1, "'%s'", nothing[i]);
    CHECK(chosen("30", 4, &why, &err) == -1 && chosen("090", 4, &why, &err) == -1);
    CHECK(chosen(" 1 ", 4, &why, &err) == 1);
    setenv("ECLAT_DEVICE", "1", 1);
    CHECK(chosen(NULL, 4, &why, &err) == 1 && strstr(why, "ECLAT_DEVICE"));
    CHECK(chosen("0", 4, &why, &err) == 0);
    setenv("ECLAT_DEVICE", "radeon", 1);
    CHECK(chosen(NULL, 4, &why, &err) == -1 && strstr(err.text, "ECLAT_DEVICE radeon"));
    unsetenv("ECLAT_DEVICE");
}

/* Returns the indices that `id` chooses, as digits: at most three. */
static const char *several(const char *id, const char **why, ec_error *err)
{
    static char text[8];
    ec_device_info devices[4];
    uint32_t indices[3] = {9, 9, 9}, count = 9;
    fake_devices(devices);
    if (ec_device_choose_several(devices, 4, id, indices, 3, &count, why, err) != EC_OK) return "";
    for (uint32_t i = 0; i < count; i++) text[i] = (char)('0' + indices[i]);
    text[count] = 0;
    return text;
}

static void lists_of_devices(void)
{
    const char *why = "";
    ec_error err = {0};
    unsetenv("ECLAT_DEVICE");
    CHECK(!strcmp(several(NULL, &why, &err), "3") && !strcmp(why, "first GPU"));
    CHECK(!strcmp(several("all", &why, &err), "013") && strstr(why, "--device")); /* not the absent one */
    CHECK(!strcmp(several("3,0", &why, &err), "30") && !strcmp(several("geforce,pocl", &why, &err), "30"));
    CHECK(!strcmp(several("intel", &why, &err), "1"));
    CHECK(!strcmp(several("0,pthread,0", &why, &err), "000")); /* three queues */
    CHECK(!strcmp(several("0,", &why, &err), "") && strstr(err.text, "empty entry"));
    CHECK(!strcmp(several("0,2", &why, &err), "") && strstr(err.text, "not available"));
    CHECK(!strcmp(several("0,all", &why, &err), ""));
    CHECK_MSG(strstr(err.text, "'0,all' contains all; give all alone, or numbers and names"), "%s", err.text);
    CHECK(!strcmp(several("0,7", &why, &err), ""));
    CHECK_MSG(strstr(err.text, "--device 7: no such device; there are 0: pthread-EPYC"), "%s", err.text);
    CHECK(!strcmp(several("3, 1", &why, &err), "31") && !strcmp(several(" pocl ,\tnvidia ", &why, &err), "03"));
    static const char *const gaps[] = {",", "0, ", " ,0", "0,,1"};
    for (size_t i = 0; i < sizeof gaps / sizeof gaps[0]; i++)
        CHECK_MSG(!strcmp(several(gaps[i], &why, &err), "") && strstr(err.text, "empty entry"), "'%s': %s", gaps[i],
                  err.text);
    CHECK(!strcmp(several("0,1,3,0", &why, &err), "") && strstr(err.text, "too long; name at most 3"));
    CHECK(chosen("all", 4, &why, &err) == -1 && strstr(err.text, "--device all: this takes one device"));
    CHECK(chosen("0,1", 4, &why, &err) == -1 && strstr(err.text, "--device 0,1: this takes one device"));
    setenv("ECLAT_DEVICE", "ALL", 1);
    CHECK(!strcmp(several(NULL, &why, &err), "013") && strstr(why, "ECLAT_DEVICE"));
    CHECK(chosen(NULL, 4, &why, &err) == -1 && strstr(err.text, "ECLAT_DEVICE ALL: this takes one device"));
    setenv("ECLAT_DEVICE", "0,radeon", 1);
    CHECK(!strcmp(several(NULL, &why, &err), "") && strstr(err.text, "ECLAT_DEVICE radeon: no such device"));
    unsetenv("ECLAT_DEVICE");
}

int main(void)
{
    device_rule();
    short_numbers_are_no_names();
    lists_of_devices();
    workarounds_go_by_the_driver();
    workarounds_can_be_forced();
    sub_groups_go_by_device_and_row();
    groups_of_cards_fill_their_threads();
    TEST_END();
}
