/* tiers: quick, full, long */
/* Kernel tests and renders inside Oclgrind's simulator: out-of-bounds accesses, data races, uninitialised values, wrong API calls. The test
 * also runs itself there with a kernel that is wrong on purpose, to check that errors are reported.
 *
 * Oclgrind 21.10 has limits. LLVM's inliner leaves an intrinsic that it does not know, so nothing is inlined. Its tracking of uninitialised
 * values fails for sub-vectors (x.lo, x.hi) and vload, and reports rays written by the host, which the path tracer uses to look for light
 * that is hard to find. So --uninitialized is only for tests without these. */
#include "kernel/kernel_run.h"

#define OPTIONS "--check-api --build-options '-cl-opt-disable -Dalways_inline=unused' "

static const char wrong[] = "kernel void wrong(global uint *x, uint how) {\n"
                            "    uint y[2], i = get_global_id(0);\n"
                            "    if (how == 0) x[64 + i] = 1;\n"
                            "    if (how == 1) x[0] = i;\n"
                            "    if (how == 2 && y[1] == 7) x[0] = 1;\n}\n";

/* Runs in the simulator. how: 0 writes beyond the end, 1 has a race, 2 reads uninitialised memory. */
static int be_wrong(uint32_t how)
{
    ec_cl cl;
    ec_error err = {0};
    cl_program program = NULL;
    cl_kernel kernel = NULL;
    cl_mem buffer = NULL;
    if (kernel_open(&cl)) return 1;
    CHECK_OK(ec_program_build(&cl, "wrong", wrong, "", &program, &err), err);
    CHECK_OK(ec_kernel_create(program, "wrong", &kernel, &err), err);
    CHECK_OK(ec_buffer_create(&cl, "x", 256, NULL, &buffer, &err), err);
    CHECK_OK(ec_kernel_arguments(kernel, (ec_argument[]){EC_ARGUMENT(buffer), EC_ARGUMENT(how)}, 2, &err), err);
    CHECK_OK(ec_kernel_run(&cl, "wrong", kernel, 4, 2, &err), err);
    CHECK_OK(ec_cl_finish(&cl, &err), err);
    TEST_END();
}

/* Runs a command in the simulator and prints the start of its log. Returns the log's size, -1 if the command failed. */
static long simulate(const char *options, const char *command, bool show)
{
    char line[8192], log[2048], text[2048];
    snprintf(log, sizeof log, "%s/oclgrind.log", ECLAT_TEST_OUT);
    remove(log);
    snprintf(line, sizeof line, "oclgrind " OPTIONS "%s --log '%s' %s >'%s.out' 2>&1", options, log, command, log);
    bool good = system(line) == 0;
    FILE *file = fopen(log, "r");
    size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
    text[size] = 0;
    if (file) fclose(file);
    if (show && size) fprintf(stderr, "%s\n", text);
    if (show && !good) fprintf(stderr, "failed: %s\n", line);
    return good ? (long)size : -1;
}

/* Every stage and accelerator, on scenes that need every effect: a few pixels each, since a sample takes a tenth of a second. */
static const struct {
    const char *tier, *ways, *options;
} renders[] = {
    {"full", "--data-races", "cornell-box/cornell-box.gltf --accel none --lanes 1 --size 4x4 --spp 2 --max-depth 3"},
    {"full", "--data-races --uninitialized", "cornell-box/cornell-box.gltf --accel none --lanes 1 --size 4x4 --spp 2 --integrator whitted"},
    {"full", "--data-races --uninitialized", "cornell-box/cornell-box.gltf --lanes 1 --size 4x4 --spp 2 --integrator raster"},
    {"long", "--data-races", "cornell-box/cornell-box.gltf --accel bvh2 --lanes 4 --size 8x8 --spp 36 --max-depth 1 --adaptive"},
    {"long", "--data-races", "lamps/lamps.gltf --env 0.1,0.2,0.3 --accel grid --lanes 1 --size 4x4 --spp 2 --max-depth 3"},
    {"long", "--data-races", "lamps/lamps.gltf --accel bvh2 --lanes 4 --size 4x4 --spp 1 --max-depth 3"},
    {"long", "--data-races", "glass/glass.gltf --accel kdtree --lanes 4 --size 4x4 --spp 2 --max-depth 3"},
    {"long", "--data-races", "glass/glass.gltf --integrator whitted --accel bvh8 --lanes 4 --size 4x4 --spp 1 --max-depth 3"},
};

static void check_renders(const char *folder)
{
    char command[2400];
    for (size_t i = 0; i < sizeof renders / sizeof *renders; i++) {
        if (!test_tier(renders[i].tier)) continue;
        snprintf(command, sizeof command, "'%s/../eclat' render '%s/scenes'/%s -q -o '%s/oclgrind.exr'", folder, ECLAT_SOURCE_DIR,
                 renders[i].options, ECLAT_TEST_OUT);
        CHECK_MSG(simulate(renders[i].ways, command, true) == 0, "%s: see above", renders[i].options);
    }
}

int main(int argc, char **argv)
{
    if (argc == 2) return be_wrong((uint32_t)atoi(argv[1]));
    if (system("command -v oclgrind >/dev/null") != 0) TEST_SKIP("oclgrind is not installed");
    unsetenv("ECLAT_DEVICE");
    char folder[1024], driver[2048], command[2200];
    snprintf(folder, sizeof folder, "%s", argv[0]);
    char *slash = strrchr(folder, '/');
    if (slash) *slash = 0;
    else snprintf(folder, sizeof folder, ".");
    snprintf(driver, sizeof driver, "%s/kernel_test_kernels", folder);
    static const char *const ways[3] = {"", "--data-races", "--uninitialized"};
    for (int how = 0; how < 3 && test_tier("quick"); how++) {
        snprintf(command, sizeof command, "'%s' %d", argv[0], how);
        CHECK_MSG(simulate(ways[how], command, false) > 0, "oclgrind did not see mistake %d", how);
    }
    if (test_tier("quick")) {
        snprintf(command, sizeof command, "'%s' driver hash", driver);
        CHECK_MSG(simulate("--data-races --uninitialized", command, true) == 0, "driver, hash: see above");
    }
    if (test_tier("full")) {
        snprintf(command, sizeof command, "'%s' driver lanes math", driver);
        CHECK_MSG(simulate("--data-races", command, true) == 0, "driver, lanes, math: see above");
    }
    check_renders(folder);
    TEST_END();
}
