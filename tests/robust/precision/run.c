/* Runs all cases' kernels on the device. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robust/precision/precision.h"
#include "robust/precision/internal.h"

enum { INPUTS = 1024, LOCAL = 64 };

typedef struct run {
    ec_cl *cl;
    cl_program program;
    cl_mem in, out, memory, params;
    float host_in[INPUTS * EC_PRECISION_WORDS], host_out[INPUTS * EC_PRECISION_RESULTS], host_memory[EC_PRECISION_MEMORY];
    ec_params host_params;
} run;

static ec_result prepare(run *r, const char *source, uint32_t lanes, ec_error *err)
{
    char options[32], label[32];
    snprintf(options, sizeof options, "-DLANES=%u", lanes);
    snprintf(label, sizeof label, "precision%u", lanes);
    EC_TRY(ec_program_build(r->cl, label, source, options, &r->program, err));
    ec_precision_fill(r->host_memory, &r->host_params);
    EC_TRY(ec_buffer_create(r->cl, "inputs", sizeof r->host_in, NULL, &r->in, err));
    EC_TRY(ec_buffer_create(r->cl, "results", sizeof r->host_out, NULL, &r->out, err));
    EC_TRY(ec_buffer_create(r->cl, "tables", sizeof r->host_memory, r->host_memory, &r->memory, err));
    return ec_buffer_create(r->cl, "params", sizeof r->host_params, &r->host_params, &r->params, err);
}

static ec_result run_kernel(run *r, const char *name, uint32_t lanes, ec_error *err)
{
    char entry[96];
    snprintf(entry, sizeof entry, "precision_%s", name);
    cl_kernel kernel;
    EC_TRY(ec_kernel_create(r->program, entry, &kernel, err));
    ec_argument arguments[] = {EC_ARGUMENT(r->in), EC_ARGUMENT(r->out), EC_ARGUMENT(r->memory), EC_ARGUMENT(r->params)};
    ec_result result;
    EC_TRY_CLEANUP(ec_buffer_write(r->cl, r->in, 0, sizeof r->host_in, r->host_in, err));
    EC_TRY_CLEANUP(ec_kernel_arguments(kernel, arguments, 4, err));
    EC_TRY_CLEANUP(ec_kernel_run(r->cl, entry, kernel, INPUTS / lanes, LOCAL, err));
    EC_TRY_CLEANUP(ec_buffer_read(r->cl, r->out, 0, sizeof r->host_out, r->host_out, err));
cleanup:
    clReleaseKernel(kernel);
    return result;
}

static const ec_precision_reference *find_reference(const char *kernel)
{
    const ec_precision_reference *reference = ec_precision_references;
    while (reference->name && strcmp(reference->name, kernel) != 0) reference++;
    return reference->name ? reference : NULL;
}

/* The inputs of a case do not depend on the other cases. */
static void make_inputs(run *r, const ec_precision_case *c)
{
    uint64_t random = 0;
    for (const char *p = c->name; *p; p++) random = random * 31 + (unsigned char)*p;
    memset(r->host_in, 0, sizeof r->host_in);
    for (uint32_t i = 0; i < INPUTS; i++) c->inputs(&random, r->host_in + (size_t)i * EC_PRECISION_WORDS);
}

static ec_result run_case(run *r, const ec_precision_case *c, uint32_t lanes, ec_precision_row *rows, uint32_t *count,
                          ec_error *err)
{
    uint32_t results = 0;
    while (results < EC_PRECISION_MOST_RESULTS && c->results[results].name) results++;
    const ec_precision_reference *reference = find_reference(c->kernel);
    if (!reference || *count + results > EC_PRECISION_ROWS)
        return ec_fail(err, "precision: no reference or no row left for '%s'", c->name);
    make_inputs(r, c);
    EC_TRY(run_kernel(r, c->kernel, lanes, err));
    ec_precision_data data = {r->host_in, r->host_out, r->host_memory, &r->host_params, INPUTS};
    ec_precision_compare(c, reference, &data, rows + *count);
    *count += results;
    return EC_OK;
}

static int most_lost_first(const void *a, const void *b)
{
    const ec_precision_row *x = a, *y = b;
    if (x->pass != y->pass) return x->pass ? 1 : -1;
    return (x->times < y->times) - (x->times > y->times);
}

ec_result ec_precision_run(ec_cl *cl, const char *source, uint32_t lanes, ec_precision_row *rows, uint32_t *count, ec_error *err)
{
    run *r = calloc(1, sizeof *r);
    if (!r) return ec_fail(err, "out of memory");
    r->cl = cl;
    *count = 0;
    ec_result result;
    EC_TRY_CLEANUP(prepare(r, source, lanes, err));
    for (const ec_precision_case *c = ec_precision_cases; c->name; c++) EC_TRY_CLEANUP(run_case(r, c, lanes, rows, count, err));
    qsort(rows, *count, sizeof *rows, most_lost_first);
cleanup:
    ec_buffer_release(cl, &r->in);
    ec_buffer_release(cl, &r->out);
    ec_buffer_release(cl, &r->memory);
    ec_buffer_release(cl, &r->params);
    if (r->program) clReleaseProgram(r->program);
    free(r);
    return result;
}
