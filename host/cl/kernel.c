/* Kernels: made, given their arguments, run. */
#include <stdio.h>

#include "cl/cl.h"

ec_result ec_kernel_create(cl_program program, const char *name, cl_kernel *kernel, ec_error *err)
{
    cl_int code;
    *kernel = clCreateKernel(program, name, &code);
    if (code == CL_INVALID_KERNEL_NAME) {
        char names[1024] = "";
        clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, sizeof names, names, NULL);
        return ec_fail(err, "the program has no kernel \"%s\"; it has %s", name, *names ? names : "none");
    }
    return ec_cl_check(code, "clCreateKernel", name, err);
}

ec_result ec_kernel_arguments(cl_kernel kernel, const ec_argument *arguments, uint32_t count, ec_error *err)
{
    char name[128] = "?", label[192];
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, NULL);
    cl_uint wanted = 0;
    EC_TRY(ec_cl_check(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof wanted, &wanted, NULL), "clGetKernelInfo",
                       name, err));
    if (wanted != count) return ec_fail(err, "kernel %s takes %u arguments, not %u", name, wanted, count);
    for (uint32_t i = 0; i < count; i++) {
        cl_int code = clSetKernelArg(kernel, i, arguments[i].bytes, arguments[i].value);
        if (code == CL_SUCCESS) continue;
        snprintf(label, sizeof label, "%s, argument %u", name, i);
        return ec_cl_check(code, "clSetKernelArg", label, err);
    }
    return EC_OK;
}

ec_result ec_kernel_run(ec_cl *cl, const char *label, cl_kernel kernel, uint64_t global, uint32_t local,
                        ec_error *err) {
    if (global == 0) return EC_OK;
    size_t group = local, items = (size_t)((global + local - 1) / local * local);
    cl_event event;
    cl_int code = clEnqueueNDRangeKernel(cl->queue, kernel, 1, NULL, &items, &group, 0, NULL, &event);
    EC_TRY(ec_cl_check(code, "clEnqueueNDRangeKernel", label, err));
    return ec_cl_launched(cl, event, label, err);
}
