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

/* One lane, and one accelerator: one whose kernels have one lane too, if there is one, for they compile twice as fast. */
static ec_kernel_set narrow_set(const ec_pipeline *p)
{
    ec_kernel_set set = {.lanes = 1, .wave = ec_pipeline_narrow_wave(p, p->effects.built), .features = p->effects.built, .calls = true};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (p->accels[a].in_use && (!set.accels || !ec_accels[a].lanes)) set.accels = 1u << a;
    return set;
}

/* One lane, for any scene without instances: all effects, and the accelerators that are chosen by themselves. */
static ec_kernel_set universal_set(const ec_pipeline *p)
{
    const uint64_t features = ec_universal_features(&p->effects);
    return (ec_kernel_set){.lanes = 1, .wave = ec_pipeline_narrow_wave(p, features), .features = features, .calls = true, .accels = 1u << ec_accel_find("bvh2") | 1u << ec_accel_find("bvh8")};
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

/* Kernels that a render may go by, and what the driver's cache says of them, which is asked for once. */
typedef struct candidate {
    ec_kernel_set set;
    ec_compile_job job;
    bool is_asked, is_compiled;
} candidate;

static bool is_compiled(ec_pipeline *p, candidate *c)
{
    if (!c->is_asked) c->is_compiled = ec_kernel_set_job(p, &c->set, &c->job, NULL) == EC_OK && ec_compile_job_is_done(p->cl, &c->job);
    c->is_asked = true;
    return c->is_compiled;
}

/* Chooses the set to begin with, and has the fast one compiled, and then the universal one for scenes to come. */
static ec_begun choose(ec_pipeline *p, const ec_cargo_head *head, candidate *c)
{
    p->waves_until_fast = head->waves_until_fast;
    p->is_narrow = p->waves_until_fast && c[EC_BEGUN_NARROW].set.wave;
    if (p->is_narrow) return EC_BEGUN_NARROW;
    if (!may_begin_narrow(p, head) || is_compiled(p, &c[EC_BEGUN_FAST])) return EC_BEGUN_FAST;
    const bool may = may_be_universal(p), has_universal = may && is_compiled(p, &c[EC_BEGUN_UNIVERSAL]);
    const ec_compile_job *wanted[2] = {&c[EC_BEGUN_FAST].job, &c[EC_BEGUN_UNIVERSAL].job};
    p->is_narrow = ec_compiler_start(wanted, may && !has_universal ? 2 : 1, &p->compiler, NULL) == EC_OK;
    if (!p->is_narrow) return EC_BEGUN_FAST;
    return has_universal && !is_compiled(p, &c[EC_BEGUN_NARROW]) ? EC_BEGUN_UNIVERSAL : EC_BEGUN_NARROW;
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
static ec_result build(ec_pipeline *p, candidate *c, ec_error *err)
{
    teller t = {.log = p->cl->log, .begun = ec_now()};
    const bool is_late = compiles_late(p), is_done = !is_late || is_compiled(p, c);
    if (!is_done) ec_say(t.log, "compiling kernels for what this scene calls for; the next render finds them");
    t.said = t.begun;
    p->kernels = c->set;
    ec_result result = ec_kernel_set_build(p, &p->kernels, err);
    p->kernels.accels &= fast_set(p).accels; /* a universal set has others too */
    if (result == EC_OK && is_late) result = ec_kernel_set_warm(p, is_done ? NULL : tell, &t, err);
    if (result == EC_OK && !is_done) ec_compile_job_done(p->cl, &c->job);
    return result;
}

ec_result ec_tiers_begin(ec_pipeline *p, const ec_cargo_head *head, ec_error *err)
{
    candidate candidates[] = {[EC_BEGUN_FAST] = {.set = fast_set(p)}, [EC_BEGUN_NARROW] = {.set = narrow_set(p)}, [EC_BEGUN_UNIVERSAL] = {.set = universal_set(p)}};
    candidate *chosen = &candidates[p->begun = choose(p, head, candidates)];
    ec_result result = p->is_narrow ? ec_pipeline_use_wave(p, chosen->set.wave, err) : EC_OK;
    if (result == EC_OK) result = build(p, chosen, err);
    for (int i = 0; i < 3; i++) ec_compile_job_free(&candidates[i].job);
    return result;
}

static ec_result switch_to_fast(ec_pipeline *p, ec_error *err)
{
    candidate fast = {.set = fast_set(p)};
    ec_kernel_set_release(&p->kernels);
    p->is_narrow = false;
    p->fast_since = ec_now();
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) memset(p->accels[a].tuning, 0, sizeof p->accels[a].tuning);
    ec_result result = ec_pipeline_use_wave(p, p->room, err);
    if (result == EC_OK) result = build(p, &fast, err);
    ec_compile_job_free(&fast.job);
    return result;
}

/* A wave of none is one for which memory became too short: the fast kernels' is larger. */
ec_result ec_tiers_step(ec_pipeline *p, ec_error *err)
{
    if (!p->is_narrow) return EC_OK;
    const bool is_due = p->waves_until_fast ? --p->waves_until_fast == 0 : ec_compiler_has_ended(&p->compiler);
    return is_due || !p->wave ? switch_to_fast(p, err) : EC_OK;
}
