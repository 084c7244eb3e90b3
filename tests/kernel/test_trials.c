/* tier: quick */
/* Trials find the fastest accelerator separately for camera paths and for light paths: camera rays are traced in packets, which are slower
 * for light paths, since these start in random directions. */
#include "device/light_batch.h"
#include "device/pipeline.h"
#include "support/render_case.h"

enum { SIZE = 32, BATCH = 8, WAVES = 16 };

static uint32_t trials(const ec_pipeline *p, const char *accel, int of_light, int sorts)
{
    return p->accels[ec_accel_find(accel)].tuning[of_light][0][0][sorts].trials;
}

static void make(const ec_scene *scene, ec_pipeline *p)
{
    ec_render_options o = case_options(SIZE, SIZE, BATCH);
    ec_render_stats stats = {0};
    ec_payload payload;
    ec_error err = {0};
    o.light_paths = 1;
    o.compile = EC_COMPILE_FIRST;
    CHECK_OK(ec_payload_make(scene, &o, BATCH, 1u << ec_device_kind_of(&case_cl()->info), NULL, &payload, &stats, &err), err);
    CHECK_OK(ec_pipeline_create(case_cl(), &payload, &payload, p, &stats, &err), err);
    CHECK_OK(ec_pipeline_fit_films(p, SIZE * SIZE, SIZE * SIZE, &err), err);
}

static void light_paths_come_first(ec_pipeline *p)
{
    bool complete;
    ec_error err = {0};
    for (uint32_t i = 0; i < WAVES; i++) CHECK_OK(ec_light_batch_run(p, i, NULL, NULL, &complete, &err), err);
    CHECK(trials(p, "bvh2", 1, 0) && trials(p, "bvh8", 1, 0));
    if (p->kernels.lanes > 1) CHECK_MSG(trials(p, "bvh2", 1, 1), "light paths' first rays are not sorted");
    CHECK(!trials(p, "bvh2", 0, 0) && !trials(p, "bvh8", 0, 0));
}

static void camera_paths_have_trials_of_their_own(ec_pipeline *p)
{
    ec_error err = {0};
    const uint32_t before = trials(p, "bvh2", 1, 0);
    for (uint32_t i = 0; i < WAVES; i++) CHECK_OK(ec_pipeline_run_wave(p, i, 0, SIZE * SIZE, false, &err), err);
    CHECK(trials(p, "bvh2", 0, 0) && trials(p, "bvh8", 0, 0));
    CHECK_MSG(!trials(p, "bvh2", 0, 1), "camera rays, which lie side by side, are sorted");
    CHECK(trials(p, "bvh2", 1, 0) == before);
}

int main(void)
{
    ec_scene *scene = case_load(OWN_SCENE("ring/ring.gltf"), NULL);
    ec_pipeline p;
    if (case_cl()->info.type & CL_DEVICE_TYPE_CPU) { /* others have one accelerator */
        make(scene, &p);
        light_paths_come_first(&p);
        camera_paths_have_trials_of_their_own(&p);
        ec_pipeline_destroy(&p);
    }
    ec_scene_free(scene);
    TEST_END();
}
