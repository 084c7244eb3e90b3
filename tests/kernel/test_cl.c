/* tier: quick */
/* host/cl: builds and their logs, kernels and buffers. */
#include "cl/build_log.h"
#include "support/cl_case.h"

static char folder[4096]; /* everything this test writes */

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
    cl->cache = EC_CACHE_ON;
    build_doubler(cl, "-DA=1");
    setenv("ECLAT_DUMP_KERNELS", dump, 1);
    CHECK(ec_program_build(cl, "shade", source, NULL, &program, &err) == EC_FAILED);
    CHECK(size_of("shade.cl") > (long)sizeof source - 1 && size_of("shade.log") > 0);
    build_doubler(cl, "-DA=1"); /* not from the cache, or there would be no log */
    CHECK(cl->cache_hits == 0 && size_of("doubler.log") >= 0);
    cl->cache = EC_CACHE_AUTO;
    unsetenv("ECLAT_DUMP_KERNELS");
}

/* A message of NVIDIA's compiler (driver 580.159, November 2026). */
static void lines_counted_from_the_start_are_put_right(const ec_cl *cl)
{
    static const char source[] = "#line 1 \"kernels/stages/shade.cl\"\n#line 41 \"kernels/lib/bsdf.h\"\n\nfloat f(float x);\n#line 2 \"kernels/stages/shade.cl\"\n}\n";
    ec_error err = {0};
    CHECK(ec_build_log_fail(cl, "shade", source, "<kernel>:4:31: error: undeclared\n  here\n<kernel>:6:1: error: brace\n", CL_BUILD_PROGRAM_FAILURE, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "\n  kernels/lib/bsdf.h:42:31: error: undeclared\n  kernels/stages/shade.cl:2:1: error: brace\n    here"), "%s", err.text);
    ec_build_log_fail(cl, "shade", "float f;\n", "<kernel>:1:2: error: a\n<built-in>: error: b\n", CL_BUILD_PROGRAM_FAILURE, &err);
    CHECK_MSG(strstr(err.text, "\n  kernels:1:2: error: a\n  <built-in>: error: b"), "%s", err.text);
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
    cl->info.memory_bytes = before + 1000; /* a smaller device than the real one */
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

/* The command runs late, when the sent memory has other contents, as after a failed device was given up. */
static void what_is_sent_may_change_meanwhile(ec_cl *cl)
{
    ec_error err = {0};
    cl_mem buffer = NULL;
    unsigned char in[64], out[64] = {0}, expected[64];
    memset(in, 7, sizeof in);
    memset(expected, 7, sizeof expected);
    CHECK_OK(ec_buffer_create(cl, "sent", sizeof in, NULL, &buffer, &err), err);
    CHECK_OK(ec_buffer_send(cl, buffer, sizeof in, in, &err), err); /* which makes room for the copy */
    CHECK_OK(ec_cl_finish(cl, &err), err);
    cl_event gate = clCreateUserEvent(cl->context, NULL);
    CHECK(clEnqueueBarrierWithWaitList(cl->queue, 1, &gate, NULL) == CL_SUCCESS);
    CHECK_OK(ec_buffer_send(cl, buffer, sizeof in, in, &err), err);
    memset(in, 9, sizeof in);
    CHECK(clSetUserEventStatus(gate, CL_COMPLETE) == CL_SUCCESS);
    CHECK_OK(ec_buffer_read(cl, buffer, 0, sizeof out, out, &err), err);
    CHECK(!memcmp(out, expected, sizeof out));
    clReleaseEvent(gate);
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
    cl_kernel kernel = NULL; /* still there, though the caller has released both */
    CHECK_OK(ec_program_build(cl, "doubler", doubler, "", &all[0], &err), err);
    CHECK_OK(ec_kernel_create(all[0], "doubler", &kernel, &err), err);
    if (kernel) clReleaseKernel(kernel);
    if (all[0]) clReleaseProgram(all[0]);
    cl->keeps_programs = false;
}

/* A second queue sees the buffers of the first one's context, also after that is closed. */
static void queues_of_one_device_share_a_context(const ec_device_info *info)
{
    ec_cl queues[2] = {{.allocated_bytes = 0}};
    ec_error err = {0};
    cl_mem buffer = NULL;
    uint32_t sent = 7, seen = 0;
    CHECK_OK(ec_cl_open(info, &queues[0], &err), err);
    CHECK_OK(ec_cl_open_beside(info, queues, 1, &queues[1], &err), err);
    CHECK(queues[0].context == queues[1].context && queues[0].queue != queues[1].queue);
    CHECK_OK(ec_buffer_create(&queues[0], "shared", sizeof sent, &sent, &buffer, &err), err);
    CHECK_OK(ec_cl_finish(&queues[0], &err), err);
    ec_cl_close(&queues[0]);
    CHECK_OK(ec_buffer_read(&queues[1], buffer, 0, sizeof seen, &seen, &err), err);
    CHECK(seen == sent);
    ec_buffer_release(&queues[1], &buffer);
    ec_cl_close(&queues[1]);
}

int main(void)
{
    ec_cl cl = {0};
    ec_error err = {0};
    if (!cl_folder(folder)) TEST_SKIP("no folder %s", folder);
    if (!cl_open(getenv("ECLAT_DEVICE"), &cl)) return 1;
    lines_counted_from_the_start_are_put_right(&cl);
    broken_source_says_where(&cl);
    unknown_kernel_is_named(&cl);
    what_is_sent_may_change_meanwhile(&cl);
    programs_are_kept_where_asked(&cl);
    buffers_hold_bytes(&cl);
    CHECK_OK(ec_cl_finish(&cl, &err), err);
    buffers_are_limited(&cl);
    queues_of_one_device_share_a_context(&cl.info);
    ec_cl_close(&cl);
    ec_cl_close(&cl); /* twice is fine */
    cl_folder_remove(folder);
    TEST_END();
}
