/* A kernel over arrays in one call, for tests and self-tests. */
#include "cl/cl.h"

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
    EC_TRY_CLEANUP(ec_kernel_run(cl, name, kernel, items, local, err));
    for (uint32_t i = 0; i < count; i++)
        if (arrays[i].use == EC_ARRAY_OUT) EC_TRY_CLEANUP(ec_buffer_read(cl, buffers[i], 0, arrays[i].bytes, arrays[i].data, err));
cleanup:
    for (uint32_t i = 0; i < count; i++) ec_buffer_release(cl, &buffers[i]);
    if (kernel) clReleaseKernel(kernel);
    return result;
}
