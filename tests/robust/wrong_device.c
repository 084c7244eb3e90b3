/* LD_PRELOADed into eclat: a device that computes wrongly without an error. All data read from it is 0. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <string.h>

typedef cl_int read_function(cl_command_queue, cl_mem, cl_bool, size_t, size_t, void *, cl_uint, const cl_event *, cl_event *);

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, void *to, cl_uint count,
                           const cl_event *list, cl_event *event)
{
    read_function *real;
    void *symbol = dlsym(RTLD_NEXT, "clEnqueueReadBuffer");
    memcpy(&real, &symbol, sizeof real);
    cl_int code = real(queue, buffer, blocking, offset, size, to, count, list, event);
    memset(to, 0, size);
    return code;
}

typedef void *map_function(cl_command_queue, cl_mem, cl_bool, cl_map_flags, size_t, size_t, cl_uint, const cl_event *, cl_event *, cl_int *);

void *clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags, size_t offset, size_t size, cl_uint count,
                         const cl_event *list, cl_event *event, cl_int *code)
{
    map_function *real;
    void *symbol = dlsym(RTLD_NEXT, "clEnqueueMapBuffer");
    memcpy(&real, &symbol, sizeof real);
    void *at = real(queue, buffer, blocking, flags, offset, size, count, list, event, code);
    if (at) memset(at, 0, size);
    return at;
}
