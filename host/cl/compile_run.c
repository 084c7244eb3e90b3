#include "cl/compile_job.h"

#include <stdlib.h>
#include <string.h>

/* Buffers of zeros, and of the constants. */
static ec_result set_arguments(const ec_compile_kernel *k, cl_kernel kernel, const cl_mem buffers[2], ec_error *err)
{
    const cl_uint zero = 0;
    for (uint32_t i = 0; i < k->argument_count; i++) {
        const ec_compile_argument what = k->arguments[i];
        const void *value = what == EC_COMPILE_SCALAR ? (const void *)&zero : &buffers[what == EC_COMPILE_CONSTANTS];
        EC_TRY(ec_cl_check(clSetKernelArg(kernel, i, what == EC_COMPILE_SCALAR ? sizeof zero : sizeof(cl_mem), value), "clSetKernelArg", k->name, err));
    }
    return EC_OK;
}

static ec_result compile(ec_cl *cl, const ec_compile_kernel *k, cl_program program, const cl_mem buffers[2], ec_error *err)
{
    cl_kernel kernel = NULL;
    EC_TRY(ec_kernel_create(program, k->name, &kernel, err));
    ec_result result = set_arguments(k, kernel, buffers, err);
    if (result == EC_OK) result = ec_kernel_run(cl, k->name, kernel, k->global, k->local, err);
    if (result == EC_OK) result = ec_cl_finish(cl, err);
    clReleaseKernel(kernel);
    return result;
}

ec_result ec_compile_job_run(ec_cl *cl, const ec_compile_job *job, void (*compiled)(uint32_t kernel), ec_error *err)
{
    enum { ZEROS = 1 << 16 };
    cl_program programs[EC_COMPILE_PROGRAMS] = {NULL};
    cl_mem buffers[2] = {NULL};
    ec_result result = ec_buffer_create(cl, "zeros", ZEROS, NULL, &buffers[0], err);
    if (result == EC_OK) result = ec_buffer_zero(cl, buffers[0], 0, ZEROS, err);
    if (result == EC_OK) result = ec_buffer_create(cl, "parameters", job->constants_bytes, job->constants, &buffers[1], err);
    for (uint32_t i = 0; result == EC_OK && i < job->kernel_count; i++) {
        const ec_compile_program *p = &job->programs[job->kernels[i].program];
        cl_program *program = &programs[job->kernels[i].program];
        if (!*program) result = ec_program_build(cl, p->label, p->source, p->options, program, err);
        if (result == EC_OK) result = compile(cl, &job->kernels[i], *program, buffers, err);
        if (result == EC_OK && compiled) compiled(i);
    }
    for (uint32_t i = 0; i < EC_COMPILE_PROGRAMS; i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    for (int i = 0; i < 2; i++) ec_buffer_release(cl, &buffers[i]);
    return result;
}
