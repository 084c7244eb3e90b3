#include "cl/pace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT 0.5          /* seconds of a launch; Windows waits for two, Linux for five to ten */
#define AIM 0.25           /* of the limit: work-items are not alike, and a card may have others to serve */
#define GROWTH 8.0         /* at most, from one look to the next */
#define FIRST_A_UNIT 256   /* work-items a compute unit before anything is known … */
#define FIRST_LEAST 4096   /* … and in all */
#define LEAST 64
#define SHORTEST 1e-6      /* seconds: no launch is done sooner, whatever the clock says; llvmpipe's has them all take a nanosecond */

ec_result ec_pace_begin(ec_cl *cl, ec_error *err)
{
    const char *wanted = getenv("ECLAT_LAUNCH_SECONDS");
    char *end = NULL;
    cl->paces.limit = cl->info.type & CL_DEVICE_TYPE_CPU ? 0.0 : LIMIT;
    if (!wanted || !*wanted) return EC_OK;
    cl->paces.limit = strtod(wanted, &end);
    if (*end || !isfinite(cl->paces.limit) || cl->paces.limit < 0)
        return ec_fail(err, "ECLAT_LAUNCH_SECONDS=%s: must be the maximum seconds for a launch, or 0 for no limit", wanted);
    return EC_OK;
}

/* Returns the pace of a label. There is room for so many labels; further ones share the last place, which is then paced by the slowest. */
ec_pace *ec_pace_of(ec_cl *cl, const char *label)
{
    ec_paces *all = &cl->paces;
    if (all->limit <= 0) return NULL;
    for (uint32_t i = 0; i < all->count; i++)
        if (!strncmp(all->table[i].label, label, sizeof all->table[i].label - 1)) return &all->table[i];
    if (all->count == EC_PACES) return &all->table[EC_PACES - 1];
    ec_pace *pace = &all->table[all->count++];
    const uint64_t first = (uint64_t)cl->info.compute_units * FIRST_A_UNIT;
    *pace = (ec_pace){.most = first > FIRST_LEAST ? first : FIRST_LEAST};
    strncpy(pace->label, label, sizeof pace->label - 1);
    return pace;
}

uint64_t ec_pace_piece(const ec_pace *pace, uint64_t left, uint64_t group)
{
    const uint64_t pieces = (left + pace->most - 1) / pace->most, even = (left + pieces - 1) / pieces;
    return (even + group - 1) / group * group;
}

void ec_pace_took(ec_cl *cl, ec_pace *pace, double seconds)
{
    if (seconds < SHORTEST) return;
    pace->seconds += seconds;
    if (seconds > pace->longest) pace->longest = seconds;
    if (seconds > cl->paces.longest) cl->paces.longest = seconds;
}

/* Fits the size of pieces. Work-items that find nothing to do end at once: only if as many were busy as a piece may have do their times tell how long
 * such a piece takes. That a piece was too long needs no such proof. */
static void learn(const ec_paces *all, ec_pace *pace)
{
    const double aim = all->limit * AIM;
    const bool is_full = pace->busy >= pace->most;
    if (pace->seconds <= 0 || (!is_full && pace->longest <= aim)) return;
    const double mean = is_full ? pace->seconds * (double)pace->most / (double)pace->busy : 0;
    const double times = aim / (mean > pace->longest ? mean : pace->longest);
    const double wanted = (double)pace->most * (times < GROWTH ? times : GROWTH);
    pace->most = wanted < LEAST ? LEAST : (uint64_t)wanted;
    pace->seconds = pace->longest = 0;
    pace->busy = 0;
}

void ec_pace_learn(ec_cl *cl)
{
    for (uint32_t i = 0; i < cl->paces.count; i++) learn(&cl->paces, &cl->paces.table[i]);
}

void ec_cl_busy(ec_cl *cl, const char *label, uint64_t items)
{
    ec_pace *pace = ec_pace_of(cl, label);
    if (pace) pace->busy += items;
}
