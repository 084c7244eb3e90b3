/* host/cl: the device rule, workarounds, the kernel cache, builds and their logs, buffers and kernels. */
#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cl/cache.h"
#include "cl/workarounds.h"
#include "pipeline/render.h"
#include "support/test.h"

static char folder[4096]; /* everything this test writes */

/* Two CPUs, an absent GPU, a GPU, in that order. */
static uint32_t fake_devices(ec_device_info devices[4])
{
    static const char *names[] = {"pthread-EPYC", "Intel Xeon 3090", "Absent GPU", "NVIDIA GeForce RTX 3090"};
    static const char *platforms[] = {"Portable Computing Language", "Intel(R) OpenCL", "NVIDIA CUDA", "NVIDIA CUDA"};
    memset(devices, 0, 4 * sizeof *devices);
    for (int i = 0; i < 4; i++) {
        strcpy(devices[i].name, names[i]);
        strcpy(devices[i].platform_name, platforms[i]);
        devices[i].type = i < 2 ? CL_DEVICE_TYPE_CPU : CL_DEVICE_TYPE_GPU;
        devices[i].available = i != 2;
        devices[i].compiler_available = true;
    }
    strcpy(devices[0].platform_version, "OpenCL 3.0 PoCL 3.1");
    return 4;
}

/* The index that `id` chooses among the first `count` fake devices, or -1. */
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
    strcpy(cl.info.platform_name, "another"); /* no workaround: what the device says, or what is asked for */
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
    CHECK(chosen("3090", 4, &why, &err) == 1); /* no index: the first name with it */
    CHECK(chosen("pocl", 4, &why, &err) == 0);
    CHECK(chosen("nvidia", 4, &why, &err) == 3); /* names come before platforms */
    CHECK(chosen("2", 4, &why, &err) == -1 && strstr(err.text, "not available"));
    CHECK(chosen("radeon", 4, &why, &err) == -1);
    CHECK(strstr(err.text, "--device radeon") && strstr(err.text, "0: pthread-EPYC") && strstr(err.text, "3: NVIDIA"));
    CHECK(chosen("4", 4, &why, &err) == -1);
    CHECK(chosen("1x", 4, &why, &err) == -1);
    setenv("ECLAT_DEVICE", "1", 1);
    CHECK(chosen(NULL, 4, &why, &err) == 1 && strstr(why, "ECLAT_DEVICE"));
    CHECK(chosen("0", 4, &why, &err) == 0);
    setenv("ECLAT_DEVICE", "radeon", 1);
    CHECK(chosen(NULL, 4, &why, &err) == -1 && strstr(err.text, "ECLAT_DEVICE radeon"));
    unsetenv("ECLAT_DEVICE");
}

/* The indices that `id` chooses, as digits: at most three. */
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
    CHECK(!strcmp(several("0,pthread", &why, &err), "") && strstr(err.text, "'0,pthread' has device 0 (pthread-EPYC) twice"));
    CHECK(!strcmp(several("0,", &why, &err), "") && strstr(err.text, "empty place"));
    CHECK(!strcmp(several("0,2", &why, &err), "") && strstr(err.text, "not available"));
    CHECK(!strcmp(several("0,all", &why, &err), "") && strstr(err.text, "all"));
    CHECK(!strcmp(several("0,1,3,0", &why, &err), "") && strstr(err.text, "too long; name 3 at most"));
    CHECK(chosen("all", 4, &why, &err) == -1 && strstr(err.text, "--device all: this takes one device"));
    CHECK(chosen("0,1", 4, &why, &err) == -1 && strstr(err.text, "--device 0,1: this takes one device"));
    setenv("ECLAT_DEVICE", "ALL", 1);
    CHECK(!strcmp(several(NULL, &why, &err), "013") && strstr(why, "ECLAT_DEVICE"));
    CHECK(chosen(NULL, 4, &why, &err) == -1 && strstr(err.text, "ECLAT_DEVICE ALL: this takes one device"));
    unsetenv("ECLAT_DEVICE");
}

static bool same_key(const ec_cache_key *a, const ec_cache_key *b) { return memcmp(a->bytes, b->bytes, 32) == 0; }

static void key_covers_everything(void)
{
    ec_device_info base[4], other;
    fake_devices(base);
    ec_cache_key key = ec_cache_key_of(base, "source", "-DA=1"), changed = ec_cache_key_of(base, "source", "-DA=1");
    CHECK(same_key(&key, &changed) && strlen(key.hex) == 64);
    changed = ec_cache_key_of(base, "source", "-DA=2");
    CHECK(!same_key(&key, &changed));
    changed = ec_cache_key_of(base, "source2", "-DA=1");
    CHECK(!same_key(&key, &changed));
    changed = ec_cache_key_of(base, "source-", "DA=1"); /* the same letters in a row */
    CHECK(!same_key(&key, &changed));
    const size_t texts[] = {offsetof(ec_device_info, name),          offsetof(ec_device_info, vendor),
                            offsetof(ec_device_info, version),       offsetof(ec_device_info, driver),
                            offsetof(ec_device_info, platform_name), offsetof(ec_device_info, platform_version)};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        other = base[0];
        ((char *)&other)[texts[i]] ^= 1;
        changed = ec_cache_key_of(&other, "source", "-DA=1");
        CHECK_MSG(!same_key(&key, &changed), "text %zu", i);
    }
}

static int files_in(const char *path)
{
    int count = 0;
    DIR *dir = opendir(path);
    for (struct dirent *entry; dir && (entry = readdir(dir));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    if (dir) closedir(dir);
    return count;
}

/* 1 hit with the right bytes, 0 miss, -1 wrong bytes. */
static int loads(const char *cache, const ec_cache_key *key, const char *expected, size_t bytes)
{
    unsigned char *data = NULL;
    size_t got = 0;
    if (!ec_cache_load(cache, key, &data, &got)) return 0;
    int verdict = got == bytes && memcmp(data, expected, bytes) == 0 ? 1 : -1;
    free(data);
    return verdict;
}

/* Changes a byte; behind the end it adds one. */
static void flip_byte(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    if (!file) return;
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc((byte ^ 0x55) & 0xff, file);
    fclose(file);
}

static void entries_are_checked(void)
{
    static const char binary[] = "not really a binary, but bytes";
    char cache[4200], path[4400], path2[4400];
    snprintf(cache, sizeof cache, "%s/a/b/entries", folder);
    ec_device_info devices[4];
    fake_devices(devices);
    ec_cache_key key = ec_cache_key_of(devices, "source", ""), key2 = ec_cache_key_of(devices, "source", "x");
    snprintf(path, sizeof path, "%s/%s.bin", cache, key.hex);
    snprintf(path2, sizeof path2, "%s/%s.bin", cache, key2.hex);
#define STORE() ec_cache_store(cache, &key, (const unsigned char *)binary, sizeof binary)
#define LOADS(k) loads(cache, k, binary, sizeof binary)
    CHECK(LOADS(&key) == 0);
    CHECK(STORE());
    CHECK(LOADS(&key) == 1);
    CHECK(files_in(cache) == 1); /* no temporary file left */
    struct stat status;
    CHECK(stat(path, &status) == 0 && status.st_size == 80 + (off_t)sizeof binary && (status.st_mode & 0077) == 0);
    for (off_t size = 0; size < status.st_size; size += 7) { /* truncated anywhere */
        CHECK(STORE() && truncate(path, size) == 0);
        CHECK_MSG(LOADS(&key) == 0, "truncated to %ld bytes", (long)size);
    }
    for (long at = 0; at < (long)status.st_size; at++) { /* one byte changed anywhere */
        CHECK(STORE());
        flip_byte(path, at);
        CHECK_MSG(LOADS(&key) == 0, "byte %ld changed", at);
    }
    CHECK(STORE());
    flip_byte(path, (long)status.st_size); /* something after the end */
    CHECK(LOADS(&key) == 0);
    CHECK(STORE() && rename(path, path2) == 0); /* another key's entry */
    CHECK(LOADS(&key2) == 0);
    CHECK(mkdir(path, 0700) == 0); /* a folder in the place of the entry */
    CHECK(LOADS(&key) == 0);
    CHECK(!STORE() && files_in(cache) == 2);
    snprintf(cache, sizeof cache, "/dev/null/cache"); /* unwritable, for root too */
    CHECK(!STORE());
    CHECK(LOADS(&key) == 0);
}

static void folder_follows_xdg(void)
{
    char path[256];
    char *xdg = strdup(getenv("XDG_CACHE_HOME")), *home = getenv("HOME") ? strdup(getenv("HOME")) : NULL;
    setenv("XDG_CACHE_HOME", "/xdg", 1);
    setenv("HOME", "/home/me", 1);
    CHECK(ec_cache_folder("/chosen", path, sizeof path) && strcmp(path, "/chosen") == 0);
    CHECK(ec_cache_folder(NULL, path, sizeof path) && strcmp(path, "/xdg/eclat/kernels") == 0);
    setenv("XDG_CACHE_HOME", "relative", 1);
    CHECK(ec_cache_folder(NULL, path, sizeof path) && strcmp(path, "/home/me/.cache/eclat/kernels") == 0);
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    CHECK(!ec_cache_folder(NULL, path, sizeof path));
    CHECK(!ec_cache_folder("/much/longer/than/that", path, 8));
    setenv("XDG_CACHE_HOME", xdg, 1);
    if (home) setenv("HOME", home, 1);
    free(xdg);
    free(home);
}

static const char doubler[] = "kernel void doubler(global float *x, float by) { x[get_global_id(0)] *= by; }\n";

/* Runs it, so that a program from the cache is known to work and not just to build. */
static void doubles(ec_cl *cl, cl_program program)
{
    float values[100], by = 2.0f;
    for (int i = 0; i < 100; i++) values[i] = (float)i;
    ec_error err = {0};
    cl_kernel kernel = NULL;
    cl_mem buffer = NULL;
    CHECK_OK(ec_kernel_create(program, "doubler", &kernel, &err), err);
    CHECK_OK(ec_buffer_create(cl, "values", 128 * sizeof *values, NULL, &buffer, &err), err);
    CHECK_OK(ec_buffer_write(cl, buffer, 0, sizeof values, values, &err), err);
    CHECK_OK(ec_kernel_arguments(kernel, (ec_argument[]){EC_ARGUMENT(buffer), EC_ARGUMENT(by)}, 2, &err), err);
    CHECK_OK(ec_kernel_run(cl, "doubler", kernel, 100, 64, &err), err); /* 128 items: inside the buffer */
    CHECK_OK(ec_kernel_run(cl, "doubler", kernel, 0, 64, &err), err);
    CHECK_OK(ec_buffer_read(cl, buffer, 0, sizeof values, values, &err), err);
    CHECK(values[1] == 2.0f && values[99] == 198.0f);
    CHECK(ec_kernel_arguments(kernel, (ec_argument[]){EC_ARGUMENT(buffer)}, 1, &err) == EC_FAILED);
    CHECK(strstr(err.text, "doubler takes 2 arguments, not 1"));
    char wrong[64] = {0};
    CHECK(ec_kernel_arguments(kernel, (ec_argument[]){EC_ARGUMENT(buffer), EC_ARGUMENT(wrong)}, 2, &err) == EC_FAILED);
    CHECK(strstr(err.text, "doubler, argument 1") && strstr(err.text, "CL_INVALID_ARG_SIZE"));
    ec_buffer_release(cl, &buffer);
    clReleaseKernel(kernel);
}

/* Builds and runs it; how the cache answered is then in cl. */
static void build_doubler(ec_cl *cl, const char *options)
{
    ec_error err = {0};
    cl_program program = NULL;
    cl->cache_hits = cl->cache_misses = 0;
    CHECK_OK(ec_program_build(cl, "doubler", doubler, options, &program, &err), err);
    if (!program) return;
    doubles(cl, program);
    clReleaseProgram(program);
}

static void programs_are_cached(ec_cl *cl)
{
    char cache[4200], path[4400], all[256];
    snprintf(cache, sizeof cache, "%s/eclat/kernels", folder); /* folder is XDG_CACHE_HOME */
    cl->cache = EC_CACHE_ON;
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1 && files_in(cache) == 1);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 1 && cl->cache_misses == 0);
    build_doubler(cl, "-DA=2");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1 && files_in(cache) == 2);
    /* A sound entry that the driver does not take: back to the source, and the entry is replaced. */
    snprintf(all, sizeof all, "-cl-std=CL1.2%s -DA=1",
             cl->info.correctly_rounded_divide_sqrt ? " -cl-fp32-correctly-rounded-divide-sqrt" : "");
    ec_cache_key key = ec_cache_key_of(&cl->info, doubler, all);
    CHECK(ec_cache_store(cache, &key, (const unsigned char *)"garbage", 8) && files_in(cache) == 2);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 1 && cl->cache_misses == 0);
    snprintf(path, sizeof path, "%s/%s.bin", cache, key.hex);
    CHECK(truncate(path, 100) == 0);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    cl->cache_dir = "/dev/null/cache";
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    cl->cache_dir = NULL;
    cl->cache = EC_CACHE_OFF;
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 0);
    CHECK(cl->build_seconds > 0.0);
}

static long size_of(const char *name)
{
    char path[4400];
    struct stat status;
    snprintf(path, sizeof path, "%s/dump/%s", folder, name);
    return stat(path, &status) == 0 ? (long)status.st_size : -1;
}

static void broken_source_says_where(ec_cl *cl)
{
    static const char source[] = "#line 1 \"kernels/stages/shade.cl\"\n#line 41 \"kernels/lib/bsdf.h\"\n\nfloat f(float x) "
                                 "{ return x + undeclared; }\n#line 2 \"kernels/stages/shade.cl\"\n"
                                 "kernel void shade(global float *x) { *x = f(*x); }\n";
    char dump[4200];
    snprintf(dump, sizeof dump, "%s/dump", folder);
    ec_error err = {0};
    cl_program program = (cl_program)&err;
    CHECK(ec_program_build(cl, "shade", source, NULL, &program, &err) == EC_FAILED && program == NULL);
    CHECK_MSG(strstr(err.text, "kernels/lib/bsdf.h:42"), "%s", err.text);
    CHECK(strstr(err.text, "undeclared") && strstr(err.text, "kernels shade do not compile on"));
    CHECK(strstr(err.text, "ECLAT_DUMP_KERNELS"));
    CHECK(size_of("shade.cl") == -1);
    setenv("ECLAT_DUMP_KERNELS", dump, 1);
    CHECK(ec_program_build(cl, "shade", source, NULL, &program, &err) == EC_FAILED);
    CHECK(size_of("shade.cl") > (long)sizeof source - 1 && size_of("shade.log") > 0);
    cl->cache = EC_CACHE_ON; /* has an entry; is not read, or there would be no log */
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && size_of("doubler.log") >= 0);
    cl->cache = EC_CACHE_AUTO;
    unsetenv("ECLAT_DUMP_KERNELS");
}

static void unknown_kernel_is_named(ec_cl *cl)
{
    ec_error err = {0};
    cl_program program = NULL;
    cl_kernel kernel;
    CHECK_OK(ec_program_build(cl, "doubler", doubler, "", &program, &err), err);
    CHECK(ec_kernel_create(program, "tripler", &kernel, &err) == EC_FAILED);
    CHECK(strstr(err.text, "tripler") && strstr(err.text, "it has doubler"));
    clReleaseProgram(program);
}

static void buffers_are_limited(ec_cl *cl)
{
    ec_error err = {0};
    cl_mem buffer = (cl_mem)&err, second = NULL;
    uint64_t before = cl->allocated_bytes;
    CHECK(ec_buffer_create(cl, "film", cl->info.max_allocation_bytes + 1, NULL, &buffer, &err) == EC_FAILED);
    CHECK(buffer == NULL && strstr(err.text, "film needs") && strstr(err.text, "MiB in one piece"));
    ec_buffer_release(cl, &buffer);
    cl->info.memory_bytes = before + 1000; /* a smaller device than there is */
    CHECK_OK(ec_buffer_create(cl, "nodes", 600, NULL, &buffer, &err), err);
    CHECK(ec_buffer_create(cl, "triangles", 401, NULL, &second, &err) == EC_FAILED && !second);
    CHECK(strstr(err.text, "triangles needs") && strstr(err.text, "are in use"));
    CHECK_OK(ec_buffer_create(cl, "triangles", 400, NULL, &second, &err), err);
    CHECK(cl->allocated_bytes == before + 1000 && cl->peak_allocated_bytes >= before + 1000);
    ec_buffer_release(cl, &second);
    ec_buffer_release(cl, &buffer);
    CHECK(cl->allocated_bytes == before && cl->peak_allocated_bytes >= before + 1000);
}

static void buffers_hold_bytes(ec_cl *cl)
{
    ec_error err = {0};
    cl_mem buffer = NULL;
    unsigned char in[1000], out[1000];
    for (int i = 0; i < 1000; i++) in[i] = (unsigned char)(i * 7 + 1);
    CHECK_OK(ec_buffer_create(cl, "bytes", sizeof in, in, &buffer, &err), err);
    CHECK_OK(ec_buffer_zero(cl, buffer, 100, 200, &err), err);
    CHECK_OK(ec_buffer_write(cl, buffer, 500, 3, "abc", &err), err);
    CHECK_OK(ec_buffer_read(cl, buffer, 0, sizeof out, out, &err), err);
    memset(in + 100, 0, 200);
    memcpy(in + 500, "abc", 3);
    CHECK(memcmp(in, out, sizeof in) == 0);
    CHECK_OK(ec_buffer_read(cl, buffer, 999, 1, out, &err), err);
    CHECK(out[0] == in[999]);
    CHECK(ec_buffer_read(cl, buffer, 999, 2, out, &err) == EC_FAILED && strstr(err.text, "CL_INVALID_VALUE"));
    ec_buffer_release(cl, &buffer);
    CHECK_OK(ec_buffer_create(cl, "empty", 0, NULL, &buffer, &err), err); /* a scene without lights */
    CHECK(buffer);
    ec_buffer_release(cl, &buffer);
    CHECK_OK(ec_buffer_create(cl, "small", 3, "xyz", &buffer, &err), err);
    CHECK_OK(ec_buffer_read(cl, buffer, 0, 3, out, &err), err);
    CHECK(memcmp(out, "xyz", 3) == 0);
    ec_buffer_release(cl, &buffer);
}

static void programs_are_kept_where_asked(ec_cl *cl)
{
    ec_error err = {0};
    cl_program all[4] = {NULL};
    for (int i = 0; i < 4; i++) {
        cl->keeps_programs = i > 0;
        CHECK_OK(ec_program_build(cl, "doubler", doubler, i == 3 ? "-DOTHER" : "", &all[i], &err), err);
    }
    CHECK(all[1] != all[0] && all[2] == all[1] && all[3] != all[1] && cl->kept_count == 2);
    for (int i = 0; i < 4; i++)
        if (all[i]) clReleaseProgram(all[i]);
    cl_kernel kernel = NULL; /* still there, though the caller has given back both */
    CHECK_OK(ec_program_build(cl, "doubler", doubler, "", &all[0], &err), err);
    CHECK_OK(ec_kernel_create(all[0], "doubler", &kernel, &err), err);
    if (kernel) clReleaseKernel(kernel);
    if (all[0]) clReleaseProgram(all[0]);
    cl->keeps_programs = false;
}

int main(void)
{
    snprintf(folder, sizeof folder, "%s/cl-XXXXXX", ECLAT_TEST_OUT);
    if (!mkdtemp(folder)) TEST_SKIP("no folder %s", folder);
    setenv("XDG_CACHE_HOME", folder, 1);
    char *device = getenv("ECLAT_DEVICE") ? strdup(getenv("ECLAT_DEVICE")) : NULL;
    device_rule();
    lists_of_devices();
    workarounds_go_by_the_driver();
    key_covers_everything();
    entries_are_checked();
    folder_follows_xdg();

    ec_device_info *devices;
    uint32_t count, index;
    ec_error err = {0};
    ec_cl cl = {0};
    CHECK_OK(ec_devices_list(&devices, &count, &err), err);
    if (test_failures) return 1;
    CHECK_OK(ec_device_choose(devices, count, device, &index, NULL, &err), err);
    if (test_failures) return 1;
    CHECK_OK(ec_cl_open(&devices[index], &cl, &err), err);
    free(devices);
    free(device);
    if (!cl.queue) return 1;
    programs_are_cached(&cl);
    broken_source_says_where(&cl);
    unknown_kernel_is_named(&cl);
    programs_are_kept_where_asked(&cl);
    buffers_hold_bytes(&cl);
    CHECK_OK(ec_cl_finish(&cl, &err), err);
    buffers_are_limited(&cl);
    ec_cl_close(&cl);
    ec_cl_close(&cl); /* twice is fine */
    char command[4200];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (!test_failures && system(command) != 0) printf("%s stays\n", folder);
    TEST_END();
}
