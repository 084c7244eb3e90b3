/* Makes kernels, sets their arguments, runs them. */
#include <stdio.h>

#include "cl/pace.h"

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

/* Part of a launch: work-items of the first dimension from `first` on, and rows, the second dimension, which a launch of one row does not have. */
typedef struct piece {
    size_t first, items, rows;
} piece;

static cl_int enqueue(ec_cl *cl, cl_kernel kernel, const piece *p, size_t group, cl_event *event)
{
    const size_t offset[2] = {p->first, 0}, global[2] = {p->items, p->rows}, local[2] = {group, 1};
    return clEnqueueNDRangeKernel(cl->queue, kernel, p->rows > 1 ? 2 : 1, p->first ? offset : NULL, global, local, 0, NULL, event);
}

/* Returns the largest power of two that the driver allows as this kernel's group size: a card's registers may not hold more of its work-items at once. */
static size_t group_most(const ec_cl *cl, cl_kernel kernel)
{
    size_t most = 0, group = 1;
    if (clGetKernelWorkGroupInfo(kernel, cl->info.id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL) != CL_SUCCESS) return 1;
    while (group * 2 <= most) group *= 2;
    return group;
}

/* Runs a piece; local is a power of two. Kernels do not depend on the size of their group. */
static ec_result run_piece(ec_cl *cl, const char *label, ec_pace *pace, cl_kernel kernel, const piece *p, size_t local, ec_error *err)
{
    cl_event event;
    cl_int code = enqueue(cl, kernel, p, local, &event);
    if (code == CL_INVALID_WORK_GROUP_SIZE) {
        const size_t most = group_most(cl, kernel);
        if (most < local) code = enqueue(cl, kernel, p, most, &event);
    }
    EC_TRY(ec_cl_check(code, "clEnqueueNDRangeKernel", label, err));
    return ec_cl_launched(cl, event, label, pace, err);
}

/* Cutting a launch is safe: no kernel asks for a launch's offset or size. */
ec_result ec_kernel_run_rows(ec_cl *cl, const char *label, cl_kernel kernel, uint64_t global, uint32_t rows, uint32_t local, ec_error *err)
{
    if (global == 0) return EC_OK;
    const uint64_t items = (global + local - 1) / local * local;
    ec_pace *pace = ec_pace_of(cl, label);
    if (!pace) return run_piece(cl, label, NULL, kernel, &(piece){.items = (size_t)items, .rows = rows}, local, err);
    cl->paces.launches++;
    for (uint64_t first = 0, count; first < items; first += count) {
        count = ec_pace_piece(pace, (items - first) * rows, (uint64_t)local * rows) / rows;
        cl->paces.pieces++;
        EC_TRY(run_piece(cl, label, pace, kernel, &(piece){(size_t)first, (size_t)count, rows}, local, err));
    }
    return EC_OK;
}

ec_result ec_kernel_run(ec_cl *cl, const char *label, cl_kernel kernel, uint64_t global, uint32_t local, ec_error *err)
{
    return ec_kernel_run_rows(cl, label, kernel, global, 1, local, err);
}

/* For tests and self-tests. */
ec_result ec_kernel_call(ec_cl *cl, cl_program program, const char *name, uint64_t items, uint32_t local, const ec_array *arrays,
                         uint32_t count, ec_error *err)
{
    cl_kernel kernel = NULL;
    cl_mem buffers[EC_CALL_ARRAYS] = {NULL};
    ec_argument arguments[EC_CALL_ARRAYS];
    ec_result result = EC_FAILED;
    if (count > EC_CALL_ARRAYS) return ec_fail(err, "%s: %u arguments are more than %d", name, count, EC_CALL_ARRAYS);
    EC_TRY_CLEANUP(ec_kernel_create(program, name, &kernel, err));
    for (uint32_t i = 0; i < count; i++) {
        arguments[i] = (ec_argument){arrays[i].bytes, arrays[i].data};
        if (arrays[i].use == EC_ARRAY_SCALAR) continue;
        arguments[i] = (ec_argument)EC_ARGUMENT(buffers[i]);
        if (!arrays[i].data) continue;
        EC_TRY_CLEANUP(ec_buffer_create(cl, name, arrays[i].bytes + EC_CALL_SLACK, NULL, &buffers[i], err));
        EC_TRY_CLEANUP(ec_buffer_write(cl, buffers[i], 0, arrays[i].bytes, arrays[i].data, err));
    }
    EC_TRY_CLEANUP(ec_kernel_arguments(kernel, arguments, count, err));
    ec_cl_busy(cl, name, items);
    EC_TRY_CLEANUP(ec_kernel_run(cl, name, kernel, items, local, err));
    for (uint32_t i = 0; i < count; i++)
        if (arrays[i].use == EC_ARRAY_OUT) EC_TRY_CLEANUP(ec_buffer_read(cl, buffers[i], 0, arrays[i].bytes, arrays[i].data, err));
cleanup:
    for (uint32_t i = 0; i < count; i++) ec_buffer_release(cl, &buffers[i]);
    if (kernel) clReleaseKernel(kernel);
    return result;
}
