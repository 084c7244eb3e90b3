/* Device memory: allocated within the device's limits and accounted for, read, written, zeroed. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cl/kept.h"

#define EC_ADOPTED (1 << 20) /* bytes: smaller buffers are copied as quickly */
#define EC_SMALLEST_BUFFER 16 /* OpenCL has no empty buffers; an empty table still needs an argument */

static double mib(uint64_t bytes) { return (double)bytes / 1048576.0; }

static ec_result check_limits(const ec_cl *cl, const char *label, uint64_t bytes, ec_error *err)
{
    uint64_t used = cl->allocated_bytes, all = cl->info.memory_bytes, left = used < all ? all - used : 0;
    if (bytes <= cl->info.max_allocation_bytes && bytes <= left) return EC_OK;
    if (bytes > cl->info.max_allocation_bytes)
        ec_fail(err, "%s needs %.1f MiB in one piece, but %s allows %.1f MiB", label, mib(bytes), cl->info.name,
                mib(cl->info.max_allocation_bytes));
    else
        ec_fail(err, "%s needs %.1f MiB, but %s has %.1f MiB, of which %.1f MiB are in use", label, mib(bytes),
                cl->info.name, mib(all), mib(used));
    ec_fail_more(err, "; try another --device, or a smaller scene or --size");
    if (err) err->kind = EC_ERROR_DEVICE_MEMORY;
    return EC_FAILED;
}

static ec_result refused(const ec_cl *cl, const char *label, uint64_t bytes, cl_int code, ec_error *err)
{
    char what[128];
    snprintf(what, sizeof what, "%s, %.1f MiB beside %.1f in use", label, mib(bytes), mib(cl->allocated_bytes));
    return ec_cl_check(code, "clCreateBuffer", what, err);
}

static void count_bytes(ec_cl *cl, uint64_t bytes)
{
    cl->allocated_bytes += bytes;
    if (cl->allocated_bytes > cl->peak_allocated_bytes) cl->peak_allocated_bytes = cl->allocated_bytes;
}

ec_result ec_buffer_create(ec_cl *cl, const char *label, uint64_t bytes, const void *host, cl_mem *buffer,
                           ec_error *err) {
    *buffer = NULL;
    EC_TRY(check_limits(cl, label, bytes, err));
    bool copy = host && bytes;
    uint64_t size = bytes < EC_SMALLEST_BUFFER ? EC_SMALLEST_BUFFER : bytes;
    cl_int code;
    /* COPY_HOST_PTR reads exactly `size` bytes, so a table smaller than the smallest buffer is written afterwards. */
    bool at_once = copy && size == bytes;
    cl_mem made = clCreateBuffer(cl->context, CL_MEM_READ_WRITE | (at_once ? CL_MEM_COPY_HOST_PTR : 0), size,
                                 at_once ? (void *)host : NULL, &code);
    if (code != CL_SUCCESS) return refused(cl, label, size, code, err);
    count_bytes(cl, size);
    if (copy && !at_once) {
        ec_result result = ec_buffer_write(cl, made, 0, bytes, host, err);
        if (result != EC_OK) {
            ec_buffer_release(cl, &made);
            return result;
        }
    }
    *buffer = made;
    return EC_OK;
}

bool ec_buffer_adopt(ec_cl *cl, const char *label, uint64_t bytes, void *memory, void(CL_CALLBACK *leave)(cl_mem buffer, void *user), void *user,
                     cl_mem *buffer)
{
    const bool is_processor = cl->info.type & CL_DEVICE_TYPE_CPU, is_aligned = (uintptr_t)memory % EC_SHARED_ALIGNMENT == 0;
    if (!memory || !is_processor || !is_aligned || bytes < EC_ADOPTED || check_limits(cl, label, bytes, NULL) != EC_OK) return false;
    cl_int code;
    cl_mem made = clCreateBuffer(cl->context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory, &code);
    if (code != CL_SUCCESS) return false;
    if (clSetMemObjectDestructorCallback(made, leave, user) != CL_SUCCESS) {
        clReleaseMemObject(made);
        return false;
    }
    count_bytes(cl, bytes);
    *buffer = made;
    return true;
}

static bool is_kept(const ec_cl *cl, cl_mem buffer)
{
    for (uint32_t i = 0; i < cl->kept_buffer_count; i++)
        if (cl->kept_buffers[i].buffer == buffer) return true;
    return false;
}

void ec_buffer_release(ec_cl *cl, cl_mem *buffer)
{
    if (!*buffer) return;
    cl->releases++;
    size_t size = 0;
    if (is_kept(cl, *buffer)) { /* its memory counts until the other reference goes */
        clReleaseMemObject(*buffer);
        *buffer = NULL;
        return;
    }
    clGetMemObjectInfo(*buffer, CL_MEM_SIZE, sizeof size, &size, NULL);
    cl->allocated_bytes -= size < cl->allocated_bytes ? size : cl->allocated_bytes;
    clReleaseMemObject(*buffer);
    *buffer = NULL;
}

ec_result ec_buffer_read(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, void *to, ec_error *err)
{
    if (bytes == 0) return EC_OK;
    cl_int code = clEnqueueReadBuffer(cl->queue, buffer, CL_TRUE, offset, bytes, to, 0, NULL, NULL);
    EC_TRY(ec_cl_check(code, "clEnqueueReadBuffer", NULL, err));
    return ec_cl_landed(cl, err);
}

ec_result ec_buffer_write(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, const void *from, ec_error *err)
{
    if (bytes == 0) return EC_OK;
    cl_int code = clEnqueueWriteBuffer(cl->queue, buffer, CL_TRUE, offset, bytes, from, 0, NULL, NULL);
    return ec_cl_check(code, "clEnqueueWriteBuffer", NULL, err);
}

ec_result ec_buffer_read_later(ec_cl *cl, cl_mem buffer, uint64_t bytes, void *to, ec_error *err)
{
    cl_event event;
    EC_TRY(ec_cl_check(clEnqueueReadBuffer(cl->queue, buffer, CL_FALSE, 0, bytes, to, 0, NULL, &event), "clEnqueueReadBuffer", NULL, err));
    return ec_cl_launched(cl, event, "reading a buffer", NULL, err);
}

ec_result ec_buffer_write_later(ec_cl *cl, cl_mem buffer, uint64_t bytes, const void *from, ec_error *err)
{
    cl_event event;
    EC_TRY(ec_cl_check(clEnqueueWriteBuffer(cl->queue, buffer, CL_FALSE, 0, bytes, from, 0, NULL, &event), "clEnqueueWriteBuffer", NULL, err));
    return ec_cl_launched(cl, event, "writing a buffer", NULL, err);
}

ec_result ec_buffer_send(ec_cl *cl, cl_mem buffer, uint64_t bytes, const void *from, ec_error *err)
{
    if (bytes > cl->sent_bytes) {
        EC_TRY(ec_cl_check(clFinish(cl->queue), "clFinish", cl->info.name, err));
        free(cl->sent);
        cl->sent = malloc(bytes);
        cl->sent_bytes = cl->sent ? bytes : 0;
        if (!cl->sent) return ec_fail(err, "out of memory while counters are sent to the device");
    }
    memcpy(cl->sent, from, bytes);
    return ec_buffer_write_later(cl, buffer, bytes, cl->sent, err);
}

ec_result ec_buffer_read_rows(ec_cl *cl, cl_mem buffer, uint64_t pitch, uint64_t bytes, uint32_t rows, void *to, ec_error *err)
{
    const size_t origin[3] = {0}, region[3] = {bytes, rows, 1};
    if (bytes == 0 || rows == 0) return EC_OK;
    cl_int code = clEnqueueReadBufferRect(cl->queue, buffer, CL_TRUE, origin, origin, region, pitch, 0, bytes, 0, to, 0, NULL, NULL);
    EC_TRY(ec_cl_check(code, "clEnqueueReadBufferRect", NULL, err));
    return ec_cl_landed(cl, err);
}

ec_result ec_buffer_write_rows(ec_cl *cl, cl_mem buffer, uint64_t pitch, uint64_t bytes, uint32_t rows, const void *from, ec_error *err)
{
    const size_t origin[3] = {0}, region[3] = {bytes, rows, 1};
    if (bytes == 0 || rows == 0) return EC_OK;
    cl_int code = clEnqueueWriteBufferRect(cl->queue, buffer, CL_TRUE, origin, origin, region, pitch, 0, bytes, 0, from, 0, NULL, NULL);
    return ec_cl_check(code, "clEnqueueWriteBufferRect", NULL, err);
}

ec_result ec_buffer_fill(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, const void *word, ec_error *err)
{
    if (bytes == 0) return EC_OK;
    cl_event event;
    cl_int code = clEnqueueFillBuffer(cl->queue, buffer, word, sizeof(cl_uint), offset, bytes, 0, NULL, &event);
    EC_TRY(ec_cl_check(code, "clEnqueueFillBuffer", NULL, err));
    return ec_cl_launched(cl, event, "filling a buffer", NULL, err);
}

ec_result ec_buffer_zero(ec_cl *cl, cl_mem buffer, uint64_t offset, uint64_t bytes, ec_error *err)
{
    const cl_uint zero = 0;
    return ec_buffer_fill(cl, buffer, offset, bytes, &zero, err);
}

ec_result ec_buffer_map(ec_cl *cl, cl_mem buffer, uint64_t bytes, bool writes, float **at, ec_error *err)
{
    cl_int code;
    *at = clEnqueueMapBuffer(cl->queue, buffer, CL_TRUE, CL_MAP_READ | (writes ? CL_MAP_WRITE : 0), 0, bytes, 0, NULL, NULL, &code);
    EC_TRY(ec_cl_check(code, "clEnqueueMapBuffer", NULL, err));
    return ec_cl_landed(cl, err);
}

ec_result ec_buffer_unmap(ec_cl *cl, cl_mem buffer, float **at, ec_error *err)
{
    if (!*at) return EC_OK;
    cl_event event;
    cl_int code = clEnqueueUnmapMemObject(cl->queue, buffer, *at, 0, NULL, &event);
    *at = NULL;
    EC_TRY(ec_cl_check(code, "clEnqueueUnmapMemObject", NULL, err));
    return ec_cl_launched(cl, event, "unmapping a buffer", NULL, err);
}
