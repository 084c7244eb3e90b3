#include "device/tiers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cl/ahead.h"
#include "cl/compile_run.h"
#include "cl/workarounds.h"
#include "device/help.h"

/* Returns the narrow set: one lane, and one accelerator. Takes one whose kernels have one lane anyway, if there is one, for they compile twice as fast. */
static ec_kernel_set narrow_set(const ec_pipeline *p)
{
    ec_kernel_set set = {.lanes = 1, .wave = ec_pipeline_narrow_wave(p, p->effects.built), .features = p->effects.built, .calls = true};
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (p->accels[a].in_use && (!set.accels || !ec_accels[a].lanes)) set.accels = 1u << a;
    return set;
}

/* Returns the universal set: one lane, for any scene without instances, with all effects, and the accelerators that are chosen by default, if it
 * needs any. */
static ec_kernel_set universal_set(const ec_pipeline *p)
{
    const uint64_t features = ec_universal_features(&p->effects);
    const uint32_t accels = p->integrator == EC_INTEGRATOR_RASTER ? 0 : 1u << ec_accel_find("bvh2") | 1u << ec_accel_find("bvh8");
    return (ec_kernel_set){.lanes = 1, .wave = ec_pipeline_narrow_wave(p, features), .features = features, .calls = true, .accels = accels};
}

static ec_compile when_to_compile(ec_compile compile)
{
    const char *wanted = getenv("ECLAT_COMPILE");
    if (compile != EC_COMPILE_AUTO || !wanted) return compile;
    return !strcmp(wanted, "first") ? EC_COMPILE_FIRST : !strcmp(wanted, "narrow") ? EC_COMPILE_NARROW : EC_COMPILE_BESIDE;
}

/* Returns whether a render may begin with narrow kernels. A width that was asked for is kept. Changing kernels later pays if the driver compiles
 * late, and needs bits that are known not to depend on it. */
static bool may_begin_narrow(ec_pipeline *p, const ec_payload_head *head)
{
    const ec_compile when = when_to_compile(head->compile);
    if (head->fast_math || head->lanes || p->lanes <= 1 || !ec_pipeline_narrow_wave(p, p->effects.built)) return false;
    if (when == EC_COMPILE_NARROW) return true;
    if (when == EC_COMPILE_FIRST || !ec_compiles_late(&p->cl->info)) return false;
    p->keeps_kernels = !ec_device_rounds(&p->cl->info);
    return !p->keeps_kernels;
}

/* Returns whether a render may begin with universal kernels. Ray trees may not: they would need a stack of branches for glass that the scene may not
 * have. */
static bool may_be_universal(const ec_pipeline *p)
{
    const ec_kernel_set set = universal_set(p);
    const bool has_accel = p->integrator == EC_INTEGRATOR_RASTER || (ec_kernel_set_fast(p).accels & set.accels);
    return p->integrator != EC_INTEGRATOR_WHITTED && has_accel && ec_pipeline_narrow_wave(p, set.features);
}

/* Kernels that a render may use, and whether the driver's cache has them, which is asked once. */
typedef struct candidate {
    ec_kernel_set set;
    ec_compile_job job;
    bool is_asked, is_compiled;
    bool is_helped; /* this render has seen the last of its kernels compiled; the job may not be marked as done yet */
} candidate;
enum { RASTERISER = EC_BEGUN_UNIVERSAL + 1, CANDIDATES };

static bool is_compiled(ec_pipeline *p, candidate *c)
{
    if (!c->is_asked) c->is_compiled = ec_kernel_set_job(p, &c->set, &c->job, NULL) == EC_OK && ec_compile_job_is_done(p->cl, &c->job);
    c->is_asked = true;
    return c->is_compiled;
}

/* Returns the job of the rasteriser's kernels, which make the preview's first picture of any scene; NULL: they are compiled already. */
static const ec_compile_job *rasterisers_job(const ec_pipeline *p, candidate *c)
{
    ec_pipeline *raster = malloc(sizeof *raster);
    if (!raster) return NULL;
    *raster = *p; /* only what says which kernels there are is used of it */
    raster->integrator = EC_INTEGRATOR_RASTER;
    c->set = universal_set(raster);
    const bool is_wanted = !is_compiled(raster, c);
    free(raster);
    return is_wanted ? &c->job : NULL;
}

/* Starts another process that compiles the fast kernels for this render, and then the universal ones for scenes to come. */
static bool compile_beside(ec_pipeline *p, candidate *c, bool wants_universal)
{
    const ec_compile_job *wanted[3] = {&c[EC_BEGUN_FAST].job}, *raster = p->integrator == EC_INTEGRATOR_RASTER ? NULL : rasterisers_job(p, &c[RASTERISER]);
    uint32_t count = 1;
    if (raster) wanted[count++] = raster;
    if (wants_universal) wanted[count++] = &c[EC_BEGUN_UNIVERSAL].job;
    return ec_compiler_start(wanted, count, &p->compiler, NULL) == EC_OK;
}

/* Chooses the set to begin with. */
static ec_begun choose(ec_pipeline *p, const ec_payload_head *head, candidate *c)
{
    p->waves_until_fast = head->waves_until_fast;
    p->is_narrow = p->waves_until_fast && c[EC_BEGUN_NARROW].set.wave;
    if (p->is_narrow) return EC_BEGUN_NARROW;
    if (!may_begin_narrow(p, head) || is_compiled(p, &c[EC_BEGUN_FAST])) return EC_BEGUN_FAST;
    const bool may = may_be_universal(p), has_universal = may && is_compiled(p, &c[EC_BEGUN_UNIVERSAL]);
    const bool is_to_stay = when_to_compile(head->compile) == EC_COMPILE_NARROW;
    if (is_to_stay) p->waves_until_fast = UINT32_MAX; /* no picture has as many waves */
    p->is_narrow = is_to_stay || compile_beside(p, c, may && !has_universal);
    if (!p->is_narrow) return EC_BEGUN_FAST;
    return has_universal && !is_compiled(p, &c[EC_BEGUN_NARROW]) ? EC_BEGUN_UNIVERSAL : EC_BEGUN_NARROW;
}

/* Seconds between messages about the progress of compiling, at least. */
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

/* Builds a set. Where the driver compiles at the first launch, all kernels are compiled here rather than in the first waves. */
static ec_result build(ec_pipeline *p, candidate *c, ec_error *err)
{
    teller t = {.log = p->cl->log, .begun = ec_now()};
    const bool is_late = ec_compiles_late(&p->cl->info), is_done = !is_late || is_compiled(p, c);
    if (!is_done && !c->is_helped) ec_say(t.log, "compiling kernels for the effects of this scene; the next render reuses them");
    t.said = t.begun;
    p->kernels = c->set;
    ec_result result = ec_kernel_set_build(p, &p->kernels, err);
    p->kernels.accels &= ec_kernel_set_fast(p).accels; /* a universal set has others too, which are not used */
    if (result == EC_OK && is_late) result = ec_kernel_set_warm(p, is_done || c->is_helped ? NULL : tell, &t, err);
    if (result == EC_OK && !is_done) ec_compile_job_done(p->cl, &c->job);
    return result;
}

/* While eclat is built: compiles what any scene can begin with, so that users' first renders find it. */
static ec_result prepare(ec_pipeline *p, candidate *c, ec_error *err)
{
    static const int kinds[] = {RASTERISER, EC_BEGUN_UNIVERSAL};
    (void)rasterisers_job(p, &c[RASTERISER]);
    (void)is_compiled(p, &c[EC_BEGUN_UNIVERSAL]);
    for (int i = 0; i < 2; i++) {
        candidate *one = &c[kinds[i]];
        if (one->is_compiled || !one->set.wave) continue; /* 0: there are none for so small a picture */
        EC_TRY(ec_compile_job_run(p->cl, &one->job, err));
        one->is_compiled = true;
    }
    return EC_OK;
}

ec_result ec_tiers_begin(ec_pipeline *p, const ec_payload_head *head, ec_error *err)
{
    candidate candidates[CANDIDATES] = {[EC_BEGUN_FAST] = {.set = ec_kernel_set_fast(p)}, [EC_BEGUN_NARROW] = {.set = narrow_set(p)}, [EC_BEGUN_UNIVERSAL] = {.set = universal_set(p)}};
    ec_result result = ec_prepares_kernels() && ec_compiles_late(&p->cl->info) ? prepare(p, candidates, err) : EC_OK;
    candidate *chosen = &candidates[p->begun = choose(p, head, candidates)];
    if (result == EC_OK && p->is_narrow) result = ec_pipeline_use_wave(p, chosen->set.wave, err);
    if (result == EC_OK && p->compiler.report >= 0) ec_help_begin(p, &candidates[EC_BEGUN_FAST].job);
    if (result == EC_OK) result = build(p, chosen, err);
    for (int i = 0; i < CANDIDATES; i++) ec_compile_job_free(&candidates[i].job);
    ec_ahead_end(p->cl);
    return result;
}

static ec_result trace_by(ec_pipeline *p, uint32_t accels, ec_error *err)
{
    p->kernels.accels = accels;
    return ec_compiles_late(&p->cl->info) ? ec_kernel_set_warm(p, NULL, NULL, err) : EC_OK;
}

/* Switches to the fast kernels; without packets if not all are compiled: packets take long to compile, and make few renders much faster. */
static ec_result switch_to_fast(ec_pipeline *p, bool is_whole, ec_error *err)
{
    candidate fast = {.set = ec_kernel_set_fast(p), .is_helped = ec_help_is_done(p)};
    const uint32_t accels = is_whole ? fast.set.accels : ec_accels_needed(fast.set.accels);
    ec_kernel_set_release(&p->kernels);
    ec_help_end(p);
    p->is_narrow = false;
    p->fast_since = ec_now();
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) memset(p->accels[a].tuning, 0, sizeof p->accels[a].tuning);
    EC_TRY(ec_pipeline_use_wave(p, p->room, err));
    if (accels != fast.set.accels) {
        p->kernels = fast.set;
        EC_TRY(ec_kernel_set_build(p, &p->kernels, err));
        return trace_by(p, accels, err);
    }
    ec_result result = build(p, &fast, err);
    ec_compile_job_free(&fast.job);
    return result;
}

/* A wave of 0 paths is one for which memory became too short: the fast kernels' wave is larger. */
ec_result ec_tiers_step(ec_pipeline *p, ec_error *err)
{
    const uint32_t accels = ec_kernel_set_fast(p).accels;
    if (!p->is_narrow && p->kernels.accels == accels) return EC_OK;
    const bool is_told = p->waves_until_fast, has_ended = !is_told && ec_compiler_has_ended(&p->compiler);
    const bool is_turn = is_told && ++p->narrow_waves % p->waves_until_fast == 0;
    if (p->is_narrow) return is_turn || has_ended || ec_help_is_done(p) || !p->wave ? switch_to_fast(p, has_ended || !p->wave, err) : EC_OK;
    return is_turn || (has_ended && p->compiler.is_whole) ? trace_by(p, accels, err) : EC_OK;
}
