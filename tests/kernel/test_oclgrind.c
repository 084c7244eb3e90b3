/* Kernel tests once more inside Oclgrind's simulator: out-of-bounds accesses, data races, uninitialised values, wrong API
 * calls. Runs itself inside it too, with a kernel that is wrong on purpose, to know that it would be told.
 *
 * Oclgrind 21.10 has its own limits: LLVM's inliner leaves an intrinsic that it does not know, so nothing is inlined; and
 * its shadow of uninitialised values breaks on sub-vectors (x.lo, x.hi) and vload, so --uninitialized is for tests without. */
#include "kernel/kernel_run.h"

#define OPTIONS "--check-api --build-options '-cl-opt-disable -Dalways_inline=unused' "

static const char wrong[] = "kernel void wrong(global uint *x, uint how) {\n"
                            "    uint y[2], i = get_global_id(0);\n"
                            "    if (how == 0) x[64 + i] = 1;\n"
                            "    if (how == 1) x[0] = i;\n"
                            "    if (how == 2 && y[1] == 7) x[0] = 1;\n}\n";

/* In the simulator: how = 0 writes behind the end, 1 races, 2 reads what nobody wrote. */
static int be_wrong(uint32_t how)
{
    ec_cl cl;
    ec_error err = {""};
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

/* Runs a command in the simulator; the log's size, -1 if the command failed. The log's start is printed. */
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

int main(int argc, char **argv)
{
    if (argc == 2) return be_wrong((uint32_t)atoi(argv[1]));
    if (system("command -v oclgrind >/dev/null") != 0) TEST_SKIP("oclgrind is not installed");
    unsetenv("ECLAT_DEVICE");
    char self[2048], driver[2048], command[2200];
    snprintf(self, sizeof self, "%s", argv[0]);
    char *slash = strrchr(self, '/');
    snprintf(driver, sizeof driver, "%.*skernel_test_kernels", slash ? (int)(slash - self + 1) : 0, self);
    static const char *const ways[3] = {"", "--data-races", "--uninitialized"};
    for (int how = 0; how < 3; how++) {
        snprintf(command, sizeof command, "'%s' %d", argv[0], how);
        CHECK_MSG(simulate(ways[how], command, false) > 0, "oclgrind did not see mistake %d", how);
    }
    snprintf(command, sizeof command, "'%s' driver lanes math", driver);
    CHECK_MSG(simulate("--data-races", command, true) == 0, "driver, lanes, math: see above");
    snprintf(command, sizeof command, "'%s' driver hash", driver);
    CHECK_MSG(simulate("--data-races --uninitialized", command, true) == 0, "driver, hash: see above");
    TEST_END();
}
