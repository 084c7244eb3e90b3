/* tier: quick */
/* Places that work-items reserve in a queue: each is given once, those of a part have no gaps, and the counter says how many there are. With an
 * addition for each work-item; with one for each sub-group, emulated on any device; and with the device's own sub-groups where it has them. */
#include "kernel/kernel_run.h"
#include "shared/params.h"
#include "shared/path_state.h"

enum { LOCAL = 64, GROUPS = 48, ITEMS = LOCAL * GROUPS, ROWS = 3, ROUNDS = 3, PART = ITEMS / ROWS * ROUNDS, NOTES = 1024 * (GROUPS + 1) };

/* How many places a work-item reserves. */
typedef uint32_t pattern(uint32_t item);
static uint32_t nobody(uint32_t item) { return 0 * item; }
static uint32_t everybody(uint32_t item) { return 1 + 0 * item; }
static uint32_t every_other(uint32_t item) { return item & 1; }
static uint32_t one_of_a_group(uint32_t item) { return item % LOCAL == 37; }
static uint32_t the_last_half(uint32_t item) { return item % LOCAL >= LOCAL / 2; }
static uint32_t as_it_comes(uint32_t item) { return (item * 2654435761u) >> 30; } /* 0 to 3 */
static const struct { const char *name; pattern *asks; } patterns[] = {
    {"nobody", nobody}, {"everybody", everybody}, {"every other", every_other}, {"one of a group", one_of_a_group}, {"the last half", the_last_half},
    {"as it comes", as_it_comes}};
enum { PATTERNS = sizeof patterns / sizeof *patterns };

static uint32_t counters[EC_PART_STRIDE * ROWS + NOTES], asks[ITEMS], places[ITEMS * ROUNDS];
static uint8_t given[PART * ROWS];

/* Checks one launch's places; returns how often work-items reserved. adds: number of additions to counters. */
static uint32_t check_places(const char *name, uint32_t *adds)
{
    uint32_t wanted[ROWS] = {0}, all = 0;
    memset(given, 0, sizeof given);
    for (uint32_t i = 0; i < ITEMS; i++)
        for (uint32_t k = 0; k < asks[i]; k++) {
            const uint32_t row = i / LOCAL % ROWS, place = places[i * ROUNDS + k];
            CHECK_MSG(place / PART == row && !given[place], "%s: work-item %u gets place %u of part %u", name, i, place, row);
            if (place < PART * ROWS) given[place] = 1;
            wanted[row]++;
        }
    *adds = 0;
    for (uint32_t row = 0; row < ROWS; row++) {
        CHECK_MSG(counters[row * EC_PART_STRIDE] == wanted[row], "%s: counter %u of part %u, not %u", name, counters[row * EC_PART_STRIDE], row, wanted[row]);
        for (uint32_t i = 0; i < wanted[row]; i++) CHECK_MSG(given[row * PART + i], "%s: gap at %u of part %u", name, i, row);
        *adds += counters[row * EC_PART_STRIDE + 1];
        all += wanted[row];
    }
    return all;
}

/* Runs all patterns on kernels built with `options`. size: work-items that add together at most; 0: not known, but more than one. Returns whether
 * kernels use sub-groups. */
static bool check_build(ec_cl *cl, const char *options, uint32_t size)
{
    const uint32_t part = PART, rows = ROWS, rounds = ROUNDS;
    uint32_t joins = 0;
    cl_program program = kernel_build(cl, "reserve", 1, options);
    for (int p = 0; program && p < PATTERNS; p++) {
        memset(counters, 0, sizeof counters);
        for (uint32_t i = 0; i < ITEMS; i++) asks[i] = patterns[p].asks(i);
        const kernel_array arrays[] = {OUT(counters, sizeof counters / sizeof *counters), IN(asks, ITEMS), SCALAR(part), SCALAR(rows), SCALAR(rounds),
                                       OUT(places, ITEMS * ROUNDS), OUT(&joins, 1)};
        if (!kernel_call(cl, program, "reserve", ITEMS, LOCAL, arrays, sizeof arrays / sizeof *arrays)) break;
        uint32_t adds;
        const uint32_t all = check_places(patterns[p].name, &adds);
        if (!joins) CHECK_MSG(adds == all, "%s: %u additions for %u places", patterns[p].name, adds, all);
        else if (patterns[p].asks == everybody) CHECK_MSG(size ? adds == all / size : adds < all, "%u additions for %u places", adds, all);
        else CHECK_MSG(adds <= all, "%s: %u additions for %u places", patterns[p].name, adds, all);
    }
    if (program) clReleaseProgram(program);
    return joins;
}

int main(void)
{
    ec_cl cl;
    const int opened = kernel_open(&cl);
    if (opened) return opened;
    CHECK(!check_build(&cl, "", 1));
    CHECK(check_build(&cl, "-DSUBGROUPS -DEMULATED", 32));
    if (!cl.info.subgroup_ballot) printf("skipped: sub-groups of the device: it has no cl_khr_subgroup_ballot\n");
    else if (!check_build(&cl, "-DSUBGROUPS", 0)) printf("skipped: sub-groups of the device: its compiler has none for OpenCL C 1.2\n");
    ec_cl_close(&cl);
    TEST_END();
}
