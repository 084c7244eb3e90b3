/* tier: quick */
/* Launches are cut so that none takes longer than the limit, whatever a work-item costs. The cards are simulated, with made-up times. */
#include "cl/pace.h"
#include "support/test.h"

enum { WAVE = 1 << 20, WAVES = 24, GROUP = 64 };

typedef struct scene {
    int waves;                 /* from this wave on, the other half of the arrays applies */
    uint32_t busy[2];          /* busy work-items of a wave … */
    double seconds[2];         /* … and the time of each */
} scene;

typedef struct card {
    uint32_t units;
    double latency;            /* time of an empty launch */
    scene scene;
} card;

/* All parts of the queue are filled alike, so that each piece has its share of the busy work-items. */
static void run_wave(ec_cl *cl, const card *card, int half)
{
    const double share = (double)card->scene.busy[half] / WAVE;
    uint64_t done = 0;
    for (uint64_t count; done < WAVE; done += count) {
        ec_pace *pace = ec_pace_of(cl, "kernel");
        count = ec_pace_piece(pace, WAVE - done, GROUP);
        CHECK_MSG(count % GROUP == 0 && count > 0 && count <= pace->most + GROUP, "%llu of %llu", (unsigned long long)count, (unsigned long long)pace->most);
        if (!count) return;
        ec_pace_took(cl, pace, card->latency + (double)count * share * card->scene.seconds[half]);
        cl->paces.pieces++;
    }
    ec_pace_learn(cl); /* the launches are done; then the queues are counted */
    ec_cl_busy(cl, "kernel", card->scene.busy[half]);
    ec_pace_learn(cl);
}

/* Returns the pieces of the last wave, none of which may take much longer than intended. */
static uint64_t run(const card *card)
{
    ec_cl cl = {.info = {.type = CL_DEVICE_TYPE_GPU, .compute_units = card->units}};
    ec_error err = {0};
    CHECK_OK(ec_pace_begin(&cl, &err), err);
    for (int wave = 0; wave < WAVES; wave++) {
        cl.paces.pieces = 0;
        if (wave == WAVES - 1) {
            CHECK_MSG(cl.paces.longest <= 0.5, "a launch took %g s", cl.paces.longest);
            cl.paces.longest = 0;
        }
        run_wave(&cl, card, wave >= card->scene.waves);
    }
    CHECK_MSG(cl.paces.longest <= 0.15, "a launch took %g s in the end", cl.paces.longest);
    return cl.paces.pieces;
}

static void cards(void)
{
    const card fast = {100, 2e-5, {0, {0, WAVE}, {0, 1e-9}}}, slow = {8, 1e-4, {0, {0, WAVE}, {0, 1e-5}}}, slowest = {1, 1e-3, {0, {0, WAVE}, {0, 1e-4}}};
    CHECK(run(&fast) == 1);
    const uint64_t pieces = run(&slow); /* 10.5 s of work in eighths of a second */
    CHECK_MSG(pieces >= 84 && pieces <= 100, "%llu pieces", (unsigned long long)pieces);
    CHECK(run(&slowest) >= 840);
}

/* A kernel's work changes from wave to wave. */
static void scenes(void)
{
    const card begins_thin = {24, 2e-5, {12, {WAVE / 10, WAVE}, {2e-6, 2e-6}}}, begins_cheap = {24, 2e-5, {1, {WAVE, WAVE}, {1e-9, 2e-6}}};
    const card gets_dear = {24, 2e-5, {12, {WAVE, WAVE / 10}, {1e-8, 2e-6}}}, does_little = {24, 2e-5, {0, {0, 10}, {0, 2e-6}}};
    CHECK(run(&begins_thin) >= 16);
    CHECK(run(&begins_cheap) >= 16);
    CHECK(run(&gets_dear) > 1);
    CHECK(run(&does_little) <= 200); /* almost nothing is known about its work-items */
}

static void limits(void)
{
    ec_cl card = {.info = {.type = CL_DEVICE_TYPE_GPU}}, processor = {.info = {.type = CL_DEVICE_TYPE_CPU}};
    ec_error err = {0};
    CHECK_OK(ec_pace_begin(&processor, &err), err);
    CHECK(!ec_pace_of(&processor, "kernel"));
    CHECK_OK(ec_pace_begin(&card, &err), err);
    CHECK(card.paces.limit == 0.5);
    CHECK(ec_pace_of(&card, "one") == ec_pace_of(&card, "one") && ec_pace_of(&card, "one") != ec_pace_of(&card, "another"));
    setenv("ECLAT_LAUNCH_SECONDS", "0.1", 1);
    CHECK_OK(ec_pace_begin(&processor, &err), err);
    CHECK(processor.paces.limit == 0.1);
    for (const char *const *wrong = (const char *const[]){"soon", "1s", "-1", "inf", NULL}; *wrong; wrong++) {
        setenv("ECLAT_LAUNCH_SECONDS", *wrong, 1);
        CHECK(ec_pace_begin(&card, &err) == EC_FAILED && strstr(err.text, *wrong));
    }
    unsetenv("ECLAT_LAUNCH_SECONDS");
}

/* A clock that always shows the same time teaches nothing. */
static void clocks(void)
{
    ec_cl cl = {.info = {.type = CL_DEVICE_TYPE_GPU, .compute_units = 24}};
    ec_error err = {0};
    CHECK_OK(ec_pace_begin(&cl, &err), err);
    ec_pace *pace = ec_pace_of(&cl, "kernel");
    const uint64_t first = pace->most;
    for (int look = 0; look < 3; look++) {
        ec_cl_busy(&cl, "kernel", WAVE);
        ec_pace_took(&cl, pace, 1e-9);
        ec_pace_learn(&cl);
    }
    CHECK(pace->most == first && cl.paces.longest == 0);
}

/* More kernels than there is room for: all share a pace. */
static void many(void)
{
    ec_cl cl = {.info = {.type = CL_DEVICE_TYPE_GPU}};
    ec_error err = {0};
    CHECK_OK(ec_pace_begin(&cl, &err), err);
    for (int i = 0; i < 2 * EC_PACES; i++) {
        char label[16];
        snprintf(label, sizeof label, "kernel %d", i);
        CHECK(ec_pace_of(&cl, label));
    }
}

int main(void)
{
    unsetenv("ECLAT_LAUNCH_SECONDS");
    limits();
    many();
    clocks();
    cards();
    scenes();
    TEST_END();
}
