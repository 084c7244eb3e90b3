#include "cl/compile_run.h"

#include <string.h>
#include <sys/mman.h>

/* Sets a kernel's arguments: zeros, buffers of zeros, and the constants. */
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
    if (result == EC_OK) result = ec_kernel_run_rows(cl, k->name, kernel, k->global, k->rows, k->local, err);
    if (result == EC_OK) result = ec_cl_finish(cl, err);
    clReleaseKernel(kernel);
    return result;
}

ec_compile_states *ec_compile_states_map(int file)
{
    void *at = mmap(NULL, sizeof(ec_compile_states), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return at == MAP_FAILED ? NULL : at;
}

void ec_compile_states_unmap(ec_compile_states *states)
{
    if (states) munmap(states, sizeof *states);
}

bool ec_compile_states_are_done(const ec_compile_states *states, uint32_t kernel_count)
{
    for (uint32_t i = 0; i < kernel_count; i++)
        if (atomic_load(&states->kernels[i]) != EC_COMPILE_DONE) return false;
    return true;
}

ec_result ec_compile_run_begin(ec_cl *cl, const ec_compile_job *job, ec_compile_states *states, ec_compile_run *run, ec_error *err)
{
    enum { ZEROS = 1 << 16 };
    *run = (ec_compile_run){.cl = cl, .job = job, .states = states};
    EC_TRY(ec_buffer_create(cl, "zeros", ZEROS, NULL, &run->buffers[0], err));
    EC_TRY(ec_buffer_zero(cl, run->buffers[0], 0, ZEROS, err));
    return ec_buffer_create(cl, "parameters", job->constants_bytes, job->constants, &run->buffers[1], err);
}

void ec_compile_run_end(ec_compile_run *run)
{
    for (uint32_t i = 0; i < EC_COMPILE_PROGRAMS; i++)
        if (run->programs[i]) clReleaseProgram(run->programs[i]);
    for (int i = 0; i < 2; i++) ec_buffer_release(run->cl, &run->buffers[i]);
    memset(run, 0, sizeof *run);
}

static bool take(atomic_uchar *state)
{
    unsigned char open = EC_COMPILE_OPEN;
    return atomic_compare_exchange_strong(state, &open, EC_COMPILE_TAKEN);
}

ec_result ec_compile_run_kernel(ec_compile_run *run, uint32_t kernel, ec_error *err)
{
    const ec_compile_kernel *k = &run->job->kernels[kernel];
    const ec_compile_program *p = &run->job->programs[k->program];
    cl_program *program = &run->programs[k->program];
    if (!*program) {
        (void)take(&run->states->programs[k->program]);
        EC_TRY(ec_program_build(run->cl, p->label, p->source, p->options, program, err));
        atomic_store(&run->states->programs[k->program], EC_COMPILE_DONE);
    }
    EC_TRY(compile(run->cl, k, *program, run->buffers, err));
    atomic_store(&run->states->kernels[kernel], EC_COMPILE_DONE);
    return EC_OK;
}

static ec_result compile_next(ec_compile_run *run, uint32_t kernel, void (*compiled)(uint32_t kernel), ec_error *err)
{
    EC_TRY(ec_compile_run_kernel(run, kernel, err));
    if (compiled) compiled(kernel);
    return EC_OK;
}

ec_result ec_compile_run_open(ec_compile_run *run, uint32_t count, void (*compiled)(uint32_t kernel), ec_error *err)
{
    for (uint32_t i = 0; i < count; i++)
        if (take(&run->states->kernels[i])) EC_TRY(compile_next(run, i, compiled, err));
    return EC_OK;
}

/* In the end it also compiles what others have taken and not finished. */
ec_result ec_compile_run_all(ec_compile_run *run, void (*compiled)(uint32_t kernel), ec_error *err)
{
    EC_TRY(ec_compile_run_open(run, run->job->kernel_count, compiled, err));
    for (uint32_t i = 0; i < run->job->kernel_count; i++)
        if (atomic_load(&run->states->kernels[i]) != EC_COMPILE_DONE) EC_TRY(compile_next(run, i, compiled, err));
    return EC_OK;
}

ec_result ec_compile_job_run(ec_cl *cl, const ec_compile_job *job, ec_error *err)
{
    ec_compile_states states = {.programs = {EC_COMPILE_OPEN}};
    ec_compile_run run;
    ec_result result = ec_compile_run_begin(cl, job, &states, &run, err);
    if (result == EC_OK) result = ec_compile_run_all(&run, NULL, err);
    if (result == EC_OK) ec_compile_job_done(cl, job);
    ec_compile_run_end(&run);
    return result;
}

bool ec_compile_run_take(ec_compile_run *run, uint32_t *kernel)
{
    for (uint32_t i = run->job->needed; i-- > 0;) {
        const uint32_t program = run->job->kernels[i].program;
        if (atomic_load(&run->states->programs[program]) == EC_COMPILE_TAKEN && !run->programs[program]) continue;
        if (!take(&run->states->kernels[i])) continue;
        *kernel = i;
        return true;
    }
    return false;
}
