#include "device/tiers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cl/workarounds.h"

static bool compiles_late(const ec_pipeline *p)
{
    const ec_workaround *driver = ec_workaround_for(&p->cl->info);
    return driver && driver->compiles_late;
}

static ec_kernel_set fast_set(const ec_pipeline *p)
{
    ec_kernel_set set = {.lanes = p->lanes, .wave = p->room, .features = p->effects.built};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) set.accels |= (uint32_t)p->accels[a].in_use << a;
    return set;
}

/* One lane, and one accelerator: that whose kernels are the same for any width, if there is one. */
static ec_kernel_set narrow_set(const ec_pipeline *p)
{
    ec_kernel_set set = {.lanes = 1, .wave = ec_pipeline_narrow_wave(p, p->effects.built), .features = p->effects.built};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (p->accels[a].in_use && (!set.accels || ec_accels[a].lanes)) set.accels = 1u << a;
    return set;
}

/* One lane, for any scene without instances: all effects, and the accelerators that are chosen by themselves. */
static ec_kernel_set universal_set(const ec_pipeline *p)
{
    const uint64_t features = ec_universal_features(&p->effects);
    return (ec_kernel_set){.lanes = 1, .wave = ec_pipeline_narrow_wave(p, features), .features = features, .accels = 1u << ec_accel_find("bvh2") | 1u << ec_accel_find("bvh8")};
}

static bool is_beside(ec_compile compile)
{
    const char *wanted = getenv("ECLAT_COMPILE");
    return compile == EC_COMPILE_BESIDE || (compile == EC_COMPILE_AUTO && !(wanted && !strcmp(wanted, "first")));
}

/* Only where it pays, and where the bits are known not to depend on it. Who asks for a width gets it. */
static bool may_begin_narrow(const ec_pipeline *p, const ec_cargo_head *head)
{
    return compiles_late(p) && ec_device_rounds(&p->cl->info) && !head->fast_math && !head->lanes && p->lanes > 1 &&
           is_beside(head->compile) && ec_pipeline_narrow_wave(p, p->effects.built);
}

/* Only paths: ray trees would need a stack of branches for glass that the scene may not have. */
static bool may_be_universal(const ec_pipeline *p)
{
    const ec_kernel_set set = universal_set(p);
    return p->integrator == EC_INTEGRATOR_PATH && (fast_set(p).accels & set.accels) && ec_pipeline_narrow_wave(p, set.features);
}

static bool is_compiled(ec_pipeline *p, const ec_kernel_set *set, ec_compile_job *job)
{
    return ec_kernel_set_job(p, set, job, NULL) == EC_OK && ec_compile_job_is_done(p->cl, job);
}

/* Chooses the set to begin with, and has the fast one compiled, and then the universal one for scenes to come. */
static ec_kernel_set choose(ec_pipeline *p, const ec_cargo_head *head)
{
    const ec_kernel_set fast = fast_set(p), narrow = narrow_set(p), universal = universal_set(p);
    ec_compile_job jobs[3] = {{.program_count = 0}};
    ec_kernel_set set = fast;
    p->waves_until_fast = head->waves_until_fast;
    p->is_narrow = p->waves_until_fast && ec_pipeline_narrow_wave(p, narrow.features);
    p->begun = p->is_narrow ? EC_BEGUN_NARROW : EC_BEGUN_FAST;
    if (p->is_narrow) return narrow;
    if (may_begin_narrow(p, head) && !is_compiled(p, &fast, &jobs[0])) {
        const bool has_narrow = is_compiled(p, &narrow, &jobs[1]), has_universal = may_be_universal(p) && is_compiled(p, &universal, &jobs[2]);
        const uint32_t after = may_be_universal(p) && !has_universal ? 1 : 0;
        const ec_compile_job *wanted[2] = {&jobs[0], &jobs[2]};
        p->is_narrow = ec_compiler_start(wanted, 1 + after, &p->compiler, NULL) == EC_OK;
        if (p->is_narrow) p->begun = has_universal && !has_narrow ? EC_BEGUN_UNIVERSAL : EC_BEGUN_NARROW;
        if (p->is_narrow) set = p->begun == EC_BEGUN_UNIVERSAL ? universal : narrow;
    }
    for (int i = 0; i < 3; i++) ec_compile_job_free(&jobs[i]);
    return set;
}

/* Says how far compiling is, at most every so many seconds. */
#define SAYS_EVERY 2.0
typedef struct teller {
    const ec_log *log;
    double begun, said;
} teller;

static void tell(void *user, uint32_t done, uint32_t count)
{
    teller *t = user;
    const double now = ec_now(), left = (now - t->begun) / done * (count - done);
    if (now - t->said < SAYS_EVERY || done == count) return;
    ec_say(t->log, "compiling kernels: %u of %u, about %.0f s left", done, count, ceil(left));
    t->said = now;
}

/* Where the driver compiles at the first launch, all that there is to compile for is compiled here, and not in the first waves. */
static ec_result build(ec_pipeline *p, ec_error *err)
{
    teller t = {.log = p->cl->log, .begun = ec_now()};
    ec_compile_job job = {.program_count = 0};
    const bool is_late = compiles_late(p), is_done = !is_late || is_compiled(p, &p->kernels, &job);
    if (!is_done) ec_say(t.log, "compiling kernels for what this scene calls for; the next render finds them");
    t.said = t.begun;
    ec_result result = ec_kernel_set_build(p, &p->kernels, err);
    p->kernels.accels &= fast_set(p).accels; /* a universal set has others too */
    if (result == EC_OK && is_late) result = ec_kernel_set_warm(p, is_done ? NULL : tell, &t, err);
    if (result == EC_OK && !is_done) ec_compile_job_done(p->cl, &job);
    ec_compile_job_free(&job);
    return result;
}

ec_result ec_tiers_begin(ec_pipeline *p, const ec_cargo_head *head, ec_error *err)
{
    p->kernels = choose(p, head);
    if (p->is_narrow) EC_TRY(ec_pipeline_use_wave(p, ec_pipeline_narrow_wave(p, p->kernels.features), err));
    return build(p, err);
}

static ec_result switch_to_fast(ec_pipeline *p, ec_error *err)
{
    ec_kernel_set_release(&p->kernels);
    p->kernels = fast_set(p);
    p->is_narrow = false;
    p->fast_since = ec_now();
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) memset(p->accels[a].tuning, 0, sizeof p->accels[a].tuning);
    EC_TRY(ec_pipeline_use_wave(p, p->room, err));
    return build(p, err);
}

ec_result ec_tiers_step(ec_pipeline *p, ec_error *err)
{
    if (!p->is_narrow) return EC_OK;
    const bool is_due = p->waves_until_fast ? --p->waves_until_fast == 0 : ec_compiler_has_ended(&p->compiler);
    return is_due ? switch_to_fast(p, err) : EC_OK;
}
