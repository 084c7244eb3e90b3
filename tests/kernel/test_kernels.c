/* tiers: quick, long */
/* The driver of kernel tests: runs every tests/kernel/test_*.cl on the device, for each lane width. See kernel_test.h. `kernel_test_kernels
 * driver lanes` runs only test_driver.cl and test_lanes.cl. */
#include <dirent.h>

#include "kernel/kernel_run.h"
#include "kernel/kernel_test.h"

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* The names between "test_" and ".cl", sorted. */
static int find_tests(char **names, int capacity)
{
    DIR *folder = opendir(ECLAT_SOURCE_DIR "/tests/kernel");
    int count = 0;
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        size_t length = strlen(entry->d_name);
        if (length <= 8 || strncmp(entry->d_name, "test_", 5) || strcmp(entry->d_name + length - 3, ".cl")) continue;
        if (count == capacity) break;
        names[count] = strdup(entry->d_name + 5);
        names[count++][length - 8] = 0;
    }
    if (folder) closedir(folder);
    qsort(names, (size_t)count, sizeof *names, by_name);
    return count;
}

static char *flatten(const char *name)
{
    char file[512];
    snprintf(file, sizeof file, "kernel/test_%s.cl", name);
    return kernel_flatten(file);
}

static void print_failure(const char *file, const char *kernel, int lanes, const test_result *r)
{
    fprintf(stderr, "FAIL test_%s.cl:%u %s LANES=%d: %u of %u checks", file, r->line, kernel, lanes, r->failures,
            r->checks);
    for (ec_uint i = 0; i < r->count && i < 4; i++) {
        float value;
        memcpy(&value, &r->values[i], sizeof value);
        fprintf(stderr, i ? ", " : "; values ");
        if (r->kind == TEST_FLOATS) fprintf(stderr, "%.9g", (double)value);
        else fprintf(stderr, "%u (0x%x)", r->values[i], r->values[i]);
    }
    fputc('\n', stderr);
}

static ec_result run_kernel(ec_cl *cl, cl_program program, const char *name, test_result *r, ec_error *err)
{
    cl_kernel kernel = NULL;
    cl_mem buffer = NULL, scratch = NULL;
    ec_result result;
    memset(r, 0, sizeof *r);
    EC_TRY(ec_kernel_create(program, name, &kernel, err));
    EC_TRY_CLEANUP(ec_buffer_create(cl, "test result", sizeof *r, r, &buffer, err));
    cl_uint count = 1;
    clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof count, &count, NULL);
    if (count > 1) EC_TRY_CLEANUP(ec_buffer_create(cl, "test scratch", TEST_SCRATCH_WORDS * 4, NULL, &scratch, err));
    if (count > 1) EC_TRY_CLEANUP(ec_buffer_zero(cl, scratch, 0, TEST_SCRATCH_WORDS * 4, err));
    EC_TRY_CLEANUP(ec_kernel_arguments(kernel, (ec_argument[]){EC_ARGUMENT(buffer), EC_ARGUMENT(scratch)}, count, err));
    EC_TRY_CLEANUP(ec_kernel_run(cl, name, kernel, 1, 1, err));
    EC_TRY_CLEANUP(ec_buffer_read(cl, buffer, 0, sizeof *r, r, err));
cleanup:
    ec_buffer_release(cl, &scratch);
    ec_buffer_release(cl, &buffer);
    clReleaseKernel(kernel);
    return result;
}

/* Runs every kernel of one program. */
static void run_program(ec_cl *cl, cl_program program, const char *file, int lanes)
{
    char names[8192] = "";
    clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, sizeof names, names, NULL);
    int kernels = 0;
    char *rest;
    for (char *name = strtok_r(names, ";", &rest); name; name = strtok_r(NULL, ";", &rest)) {
        ec_error err = {0};
        test_result r;
        test_checks++;
        kernels++;
        if (run_kernel(cl, program, name, &r, &err) != EC_OK)
            fprintf(stderr, "FAIL test_%s.cl %s LANES=%d: %s\n", file, name, lanes, err.text);
        else if (r.checks == 0) fprintf(stderr, "FAIL test_%s.cl %s LANES=%d: checks nothing\n", file, name, lanes);
        else if (r.failures) print_failure(file, name, lanes, &r);
        else continue;
        test_failures++;
    }
    CHECK_MSG(kernels > 0, "test_%s.cl has no kernels", file);
}

/* Builds and runs one lane width with one set of options. */
static void run_variant(ec_cl *cl, const char *name, const char *source, int lanes, const char *more)
{
    char options[512], label[128];
    snprintf(options, sizeof options, "-DLANES=%d%s%s %s", lanes, cl->info.correctly_rounded_divide_sqrt ? " -DCORRECTLY_ROUNDED" : "",
             cl->info.denormals ? " -DDENORMALS" : "", more);
    snprintf(label, sizeof label, "test_%.90s_%d", name, lanes);
    ec_error err = {0};
    cl_program program = NULL;
    int before = test_failures;
    CHECK_OK(ec_program_build(cl, label, source, options, &program, &err), err);
    if (program) {
        run_program(cl, program, name, lanes);
        clReleaseProgram(program);
    }
    if (test_failures > before && *more) fprintf(stderr, "(built with %s)\n", more);
}

/* Every line "// options: -DX …" of a test requests a build; without such a line there is one build without options. */
static void run_test(ec_cl *cl, const char *name)
{
    static const char directive[] = "\n// options:";
    char *source = flatten(name);
    CHECK_MSG(source, "test_%s.cl cannot be flattened", name);
    for (int i = 0; source && i < kernel_widths(cl); i++) {
        const char *at = strstr(source, directive);
        if (!at) run_variant(cl, name, source, lane_widths[i], "");
        for (; at; at = strstr(at + 1, directive)) {
            char more[256];
            const char *text = at + sizeof directive - 1;
            snprintf(more, sizeof more, "%.*s", (int)strcspn(text, "\n"), text);
            run_variant(cl, name, source, lane_widths[i], more);
        }
    }
    free(source);
}

/* The driver must report failures, or it would let everything pass. */
static void driver_sees_failures(ec_cl *cl)
{
    char *source = flatten("driver");
    ec_error err = {0};
    cl_program program = NULL;
    test_result r = {0};
    CHECK_OK(ec_program_build(cl, "test_driver_fails", source ? source : "", "-DTEST_MUST_FAIL", &program, &err), err);
    if (program) {
        CHECK_OK(run_kernel(cl, program, "must_fail", &r, &err), err);
        float value = 0.0f;
        memcpy(&value, &r.values[1], sizeof value);
        CHECK(r.checks == 3 && r.failures == 2 && r.line == 1000 && r.kind == TEST_FLOATS && r.count == 3);
        CHECK_NEAR(value, 2.5, 0.0);
        clReleaseProgram(program);
    }
    free(source);
}

static bool wanted(const char *name, int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], name) == 0) return true;
    return argc == 1;
}

int main(int argc, char **argv)
{
    ec_device_info *devices;
    uint32_t count, index;
    const char *why;
    ec_error err = {0};
    ec_cl cl = {0};
    if (ec_devices_list(&devices, &count, &err) != EC_OK) TEST_SKIP("%s", err.text);
    CHECK_OK(ec_device_choose(devices, count, NULL, &index, &why, &err), err);
    if (test_failures) return 1;
    printf("%s (%s)\n", devices[index].name, why);
    CHECK_OK(ec_cl_open(&devices[index], &cl, &err), err);
    char *names[512];
    int tests = find_tests(names, 512);
    CHECK_MSG(tests > 0, "no tests in %s", ECLAT_SOURCE_DIR "/tests/kernel");
    if (cl.queue) driver_sees_failures(&cl);
    for (int i = 0; i < tests; i++) {
        if (cl.queue && wanted(names[i], argc, argv)) run_test(&cl, names[i]);
        free(names[i]);
    }
    ec_cl_close(&cl);
    free(devices);
    TEST_END();
}
