/* Opening and closing one device: its context and its queue. */
#include <stdlib.h>
#include <string.h>

#include "cl/cl.h"
#include "cl/ahead.h"
#include "cl/kept.h"
#include "cl/pace.h"

static ec_result share_or_create_context(ec_cl *cl, const ec_cl *opened, uint32_t count, ec_error *err)
{
    for (uint32_t i = 0; i < count; i++) {
        if (opened[i].info.id != cl->info.id) continue;
        EC_TRY(ec_cl_check(clRetainContext(opened[i].context), "clRetainContext", cl->info.name, err));
        cl->context = opened[i].context;
        return EC_OK;
    }
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)cl->info.platform, 0};
    cl_int code;
    cl->context = clCreateContext(properties, 1, &cl->info.id, NULL, NULL, &code);
    return ec_cl_check(code, "clCreateContext", cl->info.name, err);
}

ec_result ec_cl_open(const ec_device_info *info, ec_cl *cl, ec_error *err) { return ec_cl_open_beside(info, NULL, 0, cl, err); }

ec_result ec_cl_open_beside(const ec_device_info *info, const ec_cl *opened, uint32_t count, ec_cl *cl, ec_error *err)
{
    memset(cl, 0, sizeof *cl);
    cl->info = *info;
    cl->releases = 1;
    EC_TRY(ec_pace_begin(cl, err));
    EC_TRY(share_or_create_context(cl, opened, count, err));
    cl_int code;
    cl->queue = clCreateCommandQueue(cl->context, info->id, cl->paces.limit > 0 ? CL_QUEUE_PROFILING_ENABLE : 0, &code);
    ec_result result = ec_cl_check(code, "clCreateCommandQueue", info->name, err);
    if (result != EC_OK) ec_cl_close(cl);
    return result;
}

void ec_cl_close(ec_cl *cl)
{
    ec_cl_forget_launches(cl);
    ec_ahead_end(cl);
    ec_kept_release(cl);
    ec_kept_buffers_release(cl);
    if (cl->queue && clFinish(cl->queue) == CL_SUCCESS) free(cl->sent); /* a device that was lost may still read it */
    if (cl->queue) clReleaseCommandQueue(cl->queue);
    if (cl->context) clReleaseContext(cl->context);
    cl->queue = NULL;
    cl->context = NULL;
    cl->sent = NULL;
    cl->sent_bytes = 0;
}

ec_result ec_cl_finish(ec_cl *cl, ec_error *err)
{
    EC_TRY(ec_cl_check(clFinish(cl->queue), "clFinish", cl->info.name, err));
    return ec_cl_landed(cl, err);
}
