/* For C tests that run kernels over arrays: a device, flattened sources, calls. Kernels for such tests are in tests/kernel/run_NAME.cl,
 * which the driver of kernel_test.h leaves out. */
#ifndef EC_TESTS_KERNEL_RUN_H
#define EC_TESTS_KERNEL_RUN_H

#include "base/random.h"
#include "cl/cl.h"
#include "cl/workarounds.h"
#include "support/test.h"

/* The first two differ most; the quick tier tests only these. */
static const int lane_widths[] = {1, 8, 4, 16};
#define LANE_WIDTHS 4
#define EIGHT 1 /* length of lane_widths */

/* Number of widths to test: those that the device's compiler supports. */
static inline int kernel_widths(const ec_cl *cl)
{
    const ec_workaround *driver = ec_workaround_for(&cl->info);
    const int wanted = test_tier("full") || test_tier("long") ? LANE_WIDTHS : 2;
    int count = 0;
    while (count < wanted && !(driver && driver->most_lanes && (uint32_t)lane_widths[count] > driver->most_lanes)) count++;
    return count;
}

/* Opens the device that ECLAT_DEVICE names, or the default. Returns 0; 77 without a device; 1 after a failure. */
static inline int kernel_open(ec_cl *cl)
{
    ec_device_info *devices;
    uint32_t count, index = 0;
    const char *why = "";
    ec_error err = {0};
    if (ec_devices_list(&devices, &count, &err) != EC_OK) TEST_SKIP("%s", err.text);
    CHECK_OK(ec_device_choose(devices, count, NULL, &index, &why, &err), err);
    if (!test_failures) CHECK_OK(ec_cl_open(&devices[index], cl, &err), err);
    if (!test_failures) printf("%s (%s)\n", devices[index].name, why);
    free(devices);
    return test_failures ? 1 : 0;
}

/* Returns the text of tests/FILE with its includes; NULL after an error, which the tool prints. */
static inline char *kernel_flatten(const char *file)
{
    char command[4096];
    snprintf(command, sizeof command, "python3 '%s/tools/embed_kernels.py' --stdout '%s/tests/%s'", ECLAT_SOURCE_DIR,
             ECLAT_SOURCE_DIR, file);
    FILE *pipe = popen(command, "r");
    if (!pipe) return NULL;
    size_t size = 0, capacity = 1 << 16;
    char *text = malloc(capacity);
    while (text) {
        size += fread(text + size, 1, capacity - 1 - size, pipe);
        if (size < capacity - 1) break;
        text = realloc(text, capacity *= 2);
    }
    if (pclose(pipe) != 0 || !text) {
        free(text);
        return NULL;
    }
    text[size] = 0;
    return text;
}

/* Builds run_NAME.cl for a lane width; NULL after a failed check. */
static inline cl_program kernel_build(ec_cl *cl, const char *name, int lanes, const char *more)
{
    char file[256], label[256], options[512];
    snprintf(file, sizeof file, "kernel/run_%s.cl", name);
    snprintf(label, sizeof label, "run_%s_%d", name, lanes);
    snprintf(options, sizeof options, "-DLANES=%d %s", lanes, more ? more : "");
    char *source = kernel_flatten(file);
    CHECK_MSG(source, "%s cannot be flattened", file);
    ec_error err = {0};
    cl_program program = NULL;
    if (source) CHECK_OK(ec_program_build(cl, label, source, options, &program, &err), err);
    free(source);
    return program;
}

typedef ec_array kernel_array;
#define KERNEL_IN EC_ARRAY_IN
#define IN EC_IN
#define OUT EC_OUT
#define SCALAR EC_SCALAR
#define KERNEL_ARRAYS EC_CALL_ARRAYS

/* Returns false after a failed check. */
static inline bool kernel_call(ec_cl *cl, cl_program program, const char *name, uint64_t items, uint32_t local,
                               const kernel_array *arrays, uint32_t count)
{
    ec_error err = {0};
    ec_result result = ec_kernel_call(cl, program, name, items, local, arrays, count, &err);
    CHECK_OK(result, err);
    return result == EC_OK;
}
#define KERNEL_CALL(cl, program, name, items, ...)                                                 \
    kernel_call(cl, program, name, items, 64, (kernel_array[]){__VA_ARGS__},                       \
                sizeof((kernel_array[]){__VA_ARGS__}) / sizeof(kernel_array))

static uint64_t test_random_state = 1;
static inline uint64_t test_random_u64(void) { return ec_random_bits(&test_random_state); }
static inline double test_random(void) { return ec_random_unit(&test_random_state); } /* [0, 1) */
static inline double test_random_in(double a, double b) { return a + (b - a) * test_random(); }

#endif
