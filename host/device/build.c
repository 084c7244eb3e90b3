/* Builds the kernels that a scene calls for, each with the features that can change its code and no others. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cl/workarounds.h"
#include "device/pipeline.h"

/* A kernel of a stage, or one of an accelerator's two; ENTRIES is at least as many as there can be. */
typedef struct entry {
    ec_stage_id stage;
    uint32_t accel, lanes; /* accel: EC_ACCEL_COUNT if the stage does not use one */
    uint32_t takes;        /* as in ec_bound_kernel */
    const char *options;   /* of its traversal; "" for none */
    char source[32], name[64];
    ec_bound_kernel *kernel;
} entry;
enum { ENTRIES = EC_STAGE_ID_COUNT + 2 * EC_ACCEL_COUNT };

static entry stage_entry(ec_kernel_set *set, ec_stage_id id)
{
    entry e = {.stage = id, .accel = EC_ACCEL_COUNT, .lanes = set->lanes, .options = "", .kernel = &set->stages[id]};
    e.takes = ec_stages[id].lanes == EC_LANES_OF_PIPELINE ? set->lanes : 1;
    snprintf(e.source, sizeof e.source, "%s", ec_stages[id].source);
    snprintf(e.name, sizeof e.name, "ec_%s", ec_stages[id].source);
    return e;
}

static entry trace_entry(const ec_pipeline *p, ec_kernel_set *set, int connect, uint32_t accel)
{
    const ec_traversal way = ec_traversal_of(&p->cl->info, accel, p->accels[accel].bytes, set->features, set->lanes);
    entry e = {.stage = connect ? EC_CONNECT : EC_INTERSECT, .accel = accel, .lanes = way.lanes, .takes = way.takes, .options = way.options};
    e.kernel = &set->traverse[accel][connect];
    snprintf(e.source, sizeof e.source, "traverse_%s", ec_accels[accel].name);
    snprintf(e.name, sizeof e.name, "ec_%s_%s", ec_stages[e.stage].source, ec_accels[accel].name);
    return e;
}

/* Lists all kernels of a set, those of needed accelerators (ec_accels_needed) before the others; returns how many. */
static uint32_t list_entries(const ec_pipeline *p, ec_kernel_set *set, entry entries[ENTRIES])
{
    uint32_t count = 0;
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++)
        if (ec_stages[id].lanes != EC_LANES_OF_ACCEL && ec_stage_is_of(&ec_stages[id], p->integrator, set->features)) entries[count++] = stage_entry(set, (ec_stage_id)id);
    const uint32_t first = ec_accels_needed(set->accels), parts[] = {first, set->accels & ~first};
    for (int i = 0; i < 2; i++)
        for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
            for (int connect = 0; parts[i] >> a & 1 && connect < 2; connect++) entries[count++] = trace_entry(p, set, connect, a);
    return count;
}

ec_kernel_set ec_kernel_set_fast(const ec_pipeline *p)
{
    ec_kernel_set set = {.lanes = p->lanes, .wave = p->room, .features = p->effects.built};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) set.accels |= (uint32_t)p->accels[a].in_use << a;
    return set;
}

/* Describes the program with all kernels of a lane width: each parse of the shared headers costs as much as compiling a stage. The caller frees the
 * source. */
static ec_result describe_width(const ec_pipeline *p, const ec_kernel_set *set, const entry *entries, uint32_t count, uint32_t lanes, ec_compile_program *program, ec_error *err)
{
    const char *names[ENTRIES + 1] = {NULL}, *traversal = "";
    uint64_t features = 0;
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (entries[i].lanes != lanes) continue;
        features |= ec_stage_features(&ec_stages[entries[i].stage], set->features);
        if (entries[i].accel == EC_ACCEL_COUNT || entries[i].stage == EC_INTERSECT) names[used++] = entries[i].source; /* a source has both traversals */
        const char *own = entries[i].options;
        if (*own && *traversal && own != traversal) return ec_fail(err, "internal error: traversals of one width that take different runs of rays");
        if (*own) traversal = own;
    }
    const char *form = lanes > 1 ? "" : set->calls ? " -DCALLS" : ec_device_joins(&p->cl->info) ? " -DSUBGROUPS" : "";
    snprintf(program->options, sizeof program->options, "-DLANES=%u -DFEATURES=0x%" PRIx64 "ul%s%s%s%s", lanes, features, traversal, form,
             ec_builtin_options(&p->cl->info), p->fast_math ? " " EC_FAST_MATH : "");
    snprintf(program->label, sizeof program->label, "lanes%u%s", lanes, p->fast_math ? "_fast" : "");
    return ec_kernel_sources_join(names, &program->source, err);
}

ec_result ec_kernel_set_build(ec_pipeline *p, ec_kernel_set *set, ec_error *err)
{
    entry entries[ENTRIES];
    const uint32_t count = list_entries(p, set, entries);
    for (uint32_t i = 0; i < count; i++) {
        cl_program *program = &set->programs[entries[i].lanes];
        ec_compile_program described = {.source = NULL};
        if (!*program) EC_TRY(describe_width(p, set, entries, count, entries[i].lanes, &described, err));
        ec_result result = *program ? EC_OK : ec_program_build(p->cl, described.label, described.source, described.options, program, err);
        free(described.source);
        if (result == EC_OK) result = ec_kernel_create(*program, entries[i].name, &entries[i].kernel->kernel, err);
        entries[i].kernel->takes = entries[i].takes;
        EC_TRY(result);
    }
    return EC_OK;
}

ec_result ec_kernel_set_warm(ec_pipeline *p, void (*compiled)(void *user, uint32_t done, uint32_t count), void *user, ec_error *err)
{
    const uint32_t nothing[EC_ARG_SCALAR_COUNT] = {0};
    entry entries[ENTRIES];
    const uint32_t count = list_entries(p, &p->kernels, entries);
    EC_TRY(ec_buffer_zero(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof(ec_counters), err));
    ec_pipeline_swap_queues(p, 0);
    for (uint32_t i = 0; i < count; i++) {
        const entry *e = &entries[i];
        if (e->accel == EC_ACCEL_COUNT) EC_TRY(ec_pipeline_launch(p, e->stage, nothing, err));
        else EC_TRY(ec_pipeline_launch_trace(p, e->stage == EC_CONNECT, e->accel, nothing, err));
        EC_TRY(ec_cl_finish(p->cl, err));
        if (compiled) compiled(user, i + 1, count);
    }
    return EC_OK;
}

static ec_result add_kernel(const ec_pipeline *p, const ec_kernel_set *set, const entry *e, uint32_t program, ec_compile_job *job, ec_error *err)
{
    const ec_stage_entry *stage = &ec_stages[e->stage];
    if (job->kernel_count == EC_COMPILE_KERNELS || stage->argument_count > EC_COMPILE_ARGUMENTS) return ec_fail(err, "internal error: too many kernels");
    ec_compile_kernel *k = &job->kernels[job->kernel_count++];
    *k = (ec_compile_kernel){.program = program, .local = ec_local_size(&p->cl->info), .argument_count = stage->argument_count};
    snprintf(k->name, sizeof k->name, "%s", e->name);
    k->global = ec_pipeline_items(e->stage, e->takes, set->wave, p->triangle_count, &k->rows);
    for (uint32_t i = 0; i < stage->argument_count; i++)
        k->arguments[i] = stage->arguments[i] < EC_ARG_SCALAR_COUNT ? EC_COMPILE_SCALAR
                          : stage->arguments[i] == EC_ARG_PARAMS  ? EC_COMPILE_CONSTANTS : EC_COMPILE_BUFFER;
    return EC_OK;
}

ec_result ec_kernel_set_job(ec_pipeline *p, const ec_kernel_set *set, ec_compile_job *job, ec_error *err)
{
    entry entries[ENTRIES];
    uint32_t programs[EC_LANES_MOST + 1];
    ec_kernel_set none = *set; /* a copy, whose kernels are not used */
    const uint32_t count = list_entries(p, &none, entries);
    ec_compile_job_for(p->cl, job);
    memset(programs, 0xff, sizeof programs);
    job->constants_bytes = sizeof p->params;
    memcpy(job->constants, &p->params, sizeof p->params);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *program = &programs[entries[i].lanes];
        if (*program == UINT32_MAX) {
            if (job->program_count == EC_COMPILE_PROGRAMS) return ec_fail(err, "internal error: too many programs");
            EC_TRY(describe_width(p, set, entries, count, entries[i].lanes, &job->programs[job->program_count], err));
            *program = job->program_count++;
        }
        EC_TRY(add_kernel(p, set, &entries[i], *program, job, err));
        if (entries[i].accel == EC_ACCEL_COUNT || ec_accels_needed(set->accels) >> entries[i].accel & 1) job->needed = job->kernel_count;
    }
    return EC_OK;
}
