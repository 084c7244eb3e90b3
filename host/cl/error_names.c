/* Names of OpenCL's error codes, and messages of failed calls. */
#include "cl/cl.h"

#define EC_CL_ERRORS(X)                                                                            \
    X(CL_SUCCESS) X(CL_DEVICE_NOT_FOUND) X(CL_DEVICE_NOT_AVAILABLE) X(CL_COMPILER_NOT_AVAILABLE)   \
    X(CL_MEM_OBJECT_ALLOCATION_FAILURE) X(CL_OUT_OF_RESOURCES) X(CL_OUT_OF_HOST_MEMORY)            \
    X(CL_PROFILING_INFO_NOT_AVAILABLE) X(CL_MEM_COPY_OVERLAP) X(CL_IMAGE_FORMAT_MISMATCH)          \
    X(CL_IMAGE_FORMAT_NOT_SUPPORTED) X(CL_BUILD_PROGRAM_FAILURE) X(CL_MAP_FAILURE)                 \
    X(CL_MISALIGNED_SUB_BUFFER_OFFSET) X(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)             \
    X(CL_COMPILE_PROGRAM_FAILURE) X(CL_LINKER_NOT_AVAILABLE) X(CL_LINK_PROGRAM_FAILURE)            \
    X(CL_DEVICE_PARTITION_FAILED) X(CL_KERNEL_ARG_INFO_NOT_AVAILABLE) X(CL_INVALID_VALUE)          \
    X(CL_INVALID_DEVICE_TYPE) X(CL_INVALID_PLATFORM) X(CL_INVALID_DEVICE) X(CL_INVALID_CONTEXT)    \
    X(CL_INVALID_QUEUE_PROPERTIES) X(CL_INVALID_COMMAND_QUEUE) X(CL_INVALID_HOST_PTR)              \
    X(CL_INVALID_MEM_OBJECT) X(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR) X(CL_INVALID_IMAGE_SIZE)        \
    X(CL_INVALID_SAMPLER) X(CL_INVALID_BINARY) X(CL_INVALID_BUILD_OPTIONS) X(CL_INVALID_PROGRAM)   \
    X(CL_INVALID_PROGRAM_EXECUTABLE) X(CL_INVALID_KERNEL_NAME) X(CL_INVALID_KERNEL_DEFINITION)     \
    X(CL_INVALID_KERNEL) X(CL_INVALID_ARG_INDEX) X(CL_INVALID_ARG_VALUE) X(CL_INVALID_ARG_SIZE)    \
    X(CL_INVALID_KERNEL_ARGS) X(CL_INVALID_WORK_DIMENSION) X(CL_INVALID_WORK_GROUP_SIZE)           \
    X(CL_INVALID_WORK_ITEM_SIZE) X(CL_INVALID_GLOBAL_OFFSET) X(CL_INVALID_EVENT_WAIT_LIST)         \
    X(CL_INVALID_EVENT) X(CL_INVALID_OPERATION) X(CL_INVALID_GL_OBJECT) X(CL_INVALID_BUFFER_SIZE)  \
    X(CL_INVALID_MIP_LEVEL) X(CL_INVALID_GLOBAL_WORK_SIZE) X(CL_INVALID_PROPERTY)                  \
    X(CL_INVALID_IMAGE_DESCRIPTOR) X(CL_INVALID_COMPILER_OPTIONS) X(CL_INVALID_LINKER_OPTIONS)     \
    X(CL_INVALID_DEVICE_PARTITION_COUNT)

const char *ec_cl_error_name(cl_int code)
{
#define EC_NAME(name) case name: return #name;
    switch (code) {
        EC_CL_ERRORS(EC_NAME)
        case -1001: return "CL_PLATFORM_NOT_FOUND_KHR"; /* from the ICD loader's extension */
        default: return "an unknown error code";
    }
#undef EC_NAME
}

ec_error_kind ec_cl_error_kind(cl_int code)
{
    switch (code) {
        case CL_OUT_OF_RESOURCES:
        case CL_OUT_OF_HOST_MEMORY:
        case CL_MEM_OBJECT_ALLOCATION_FAILURE: return EC_ERROR_DEVICE_MEMORY;
        default: return EC_ERROR_DEVICE;
    }
}

static const char *remedy(cl_int code)
{
    switch (code) {
        case CL_OUT_OF_RESOURCES: /* NVIDIA reports a crashed kernel so, too */
            return "the device ran out of memory or was reset; try a smaller --size, or another --device";
        case CL_MEM_OBJECT_ALLOCATION_FAILURE: return "the device has no memory left; try a smaller --size, or another --device";
        case CL_OUT_OF_HOST_MEMORY: return "the driver found no memory left; end other programs, or try a smaller --size";
        case CL_DEVICE_NOT_AVAILABLE:
        case CL_INVALID_COMMAND_QUEUE:
        case CL_INVALID_CONTEXT:
        case CL_INVALID_DEVICE:
        case CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST:
            return "the device was lost or reset; run it again, or try another --device";
        default: return "the driver refused it; try another --device or driver";
    }
}

ec_result ec_cl_check(cl_int code, const char *call, const char *label, ec_error *err)
{
    if (code == CL_SUCCESS) return EC_OK;
    const char *open = label && *label ? " (" : "", *close = *open ? ")" : "";
    ec_fail(err, "%s%s%s%s failed: %s (%d); %s", call, open, *open ? label : "", close, ec_cl_error_name(code), code, remedy(code));
    if (err) err->kind = ec_cl_error_kind(code);
    return EC_FAILED;
}
