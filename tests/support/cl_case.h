/* Shared by the tests of host/cl: fake devices, a folder for the cache, the device under test, a small program. */
#ifndef EC_TESTS_SUPPORT_CL_CASE_H
#define EC_TESTS_SUPPORT_CL_CASE_H

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cl/cl.h"
#include "support/test.h"

/* Two CPUs, an absent GPU, a GPU, in that order. */
static inline uint32_t fake_devices(ec_device_info devices[4])
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

/* Makes a new folder for everything that a test writes, including the cache; false where it cannot be made. */
static inline bool cl_folder(char folder[4096])
{
    snprintf(folder, 4096, "%s/cl-XXXXXX", ECLAT_TEST_OUT);
    return mkdtemp(folder) && setenv("XDG_CACHE_HOME", folder, 1) == 0;
}

/* Removes the folder, unless the test has failed. */
static inline void cl_folder_remove(const char *folder)
{
    char command[4200];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (!test_failures && system(command) != 0) printf("%s stays\n", folder);
}

/* Opens the device under test; false where a check has failed. */
static inline bool cl_open(const char *id, ec_cl *cl)
{
    ec_device_info *devices = NULL;
    uint32_t count = 0, index = 0;
    ec_error err = {0};
    CHECK_OK(ec_devices_list(&devices, &count, &err), err);
    if (!test_failures) CHECK_OK(ec_device_choose(devices, count, id, &index, NULL, &err), err);
    if (!test_failures) CHECK_OK(ec_cl_open(&devices[index], cl, &err), err);
    free(devices);
    return cl->queue;
}

static const char doubler[] = "kernel void doubler(global float *x, float by) { x[get_global_id(0)] *= by; }\n";

/* Runs the program, to show that one from the cache works and does not just build. */
static inline void doubles(ec_cl *cl, cl_program program)
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

/* Builds and runs it; afterwards cl has the cache's counts. */
static inline void build_doubler(ec_cl *cl, const char *options)
{
    ec_error err = {0};
    cl_program program = NULL;
    cl->cache_hits = cl->cache_misses = 0;
    CHECK_OK(ec_program_build(cl, "doubler", doubler, options, &program, &err), err);
    if (!program) return;
    doubles(cl, program);
    clReleaseProgram(program);
}

#endif
