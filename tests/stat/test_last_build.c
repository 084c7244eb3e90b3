/* tier: quick */
/* Builds the kernels of a scene's last render while the scene is loaded. Wrong or damaged notes cost time, but change no bit of the
 * picture. */
#include "cl/ahead.h"
#include "cl/notes.h"
#include "cl/workarounds.h"
#include "device/ahead.h"
#include "support/render_case.h"

#define NAME "a scene that is not there"

static ec_render_options options(void)
{
    ec_render_options o = case_options(32, 24, 1);
    o.lanes = 1;
    o.accel = "bvh8";
    return o;
}

/* Renders, and returns the plan that is noted afterwards. */
static ec_build_plan render(const char *path, const case_image *expected, bool begins)
{
    ec_scene *scene = case_load(path, NULL);
    ec_render_options o = options();
    ec_last_build last_build, after;
    ec_last_build_begin(&last_build, case_cl(), NAME, o.integrator);
    CHECK(last_build.is_begun == begins);
    CHECK(!begins || case_cl()->ahead);
    case_image image = case_render(scene, &o);
    CHECK(case_same_bits(&image.film, &expected->film));
    CHECK(!case_cl()->last_build);
    ec_last_build_begin(&after, case_cl(), NAME, o.integrator);
    CHECK(after.is_begun == ec_compiles_late(&case_cl()->info));
    ec_ahead_end(case_cl());
    case_cl()->last_build = NULL;
    case_free(&image);
    ec_scene_free(scene);
    return after.plan;
}

/* Another size needs the same programs. */
static void programs_stay(ec_build_plan plan)
{
    ec_cl *cl = case_cl();
    ec_compile_job none = {0};
    ec_last_build small, large;
    ec_notes_write(cl, "plan 1, integrator 0, small", &plan, sizeof plan);
    plan.height *= 2;
    ec_notes_write(cl, "plan 1, integrator 0, large", &plan, sizeof plan);
    ec_last_build_begin(&small, cl, "small", EC_INTEGRATOR_PATH);
    CHECK(small.is_begun && !ec_ahead_is_done(cl, &none)); /* this waits for the build */
    const cl_program built = cl->ahead->programs[0];
    CHECK(built && clRetainProgram(built) == CL_SUCCESS); /* a new program cannot get its address */
    ec_last_build_begin(&large, cl, "large", EC_INTEGRATOR_PATH);
    CHECK(large.is_begun && !ec_ahead_is_done(cl, &none) && cl->ahead->programs[0] == built);
    plan.lanes = 4;
    ec_notes_write(cl, "plan 1, integrator 0, large", &plan, sizeof plan);
    ec_last_build_begin(&large, cl, "large", EC_INTEGRATOR_PATH);
    CHECK(large.is_begun && !ec_ahead_is_done(cl, &none) && cl->ahead->programs[0] != built);
    ec_ahead_end(cl);
    clReleaseProgram(built);
    cl->last_build = NULL;
}

int main(void)
{
    const char *const first = OWN_SCENE("cornell-box/cornell-box.gltf"), *const second = OWN_SCENE("furnace/box-albedo-0.5.gltf");
    ec_render_options o = options();
    case_image expected = case_render_file(first, NULL, &o), other = case_render_file(second, NULL, &o);
    const bool is_late = ec_compiles_late(&case_cl()->info);
    ec_last_build r;
    ec_last_build_begin(&r, case_cl(), NAME, EC_INTEGRATOR_WHITTED);
    CHECK(!r.is_begun); /* the note is of another integrator */

    ec_build_plan none;
    memset(&none, 0, sizeof none);
    snprintf(r.name, sizeof r.name, "plan 1, integrator %u, %s", o.integrator, NAME);
    ec_notes_write(case_cl(), r.name, &none, sizeof none);
    const ec_build_plan plan = render(first, &expected, false); /* a plan without a picture is rejected */
    const ec_build_plan again = render(first, &expected, is_late);
    CHECK(!memcmp(&plan, &again, sizeof plan));
    const ec_build_plan changed = render(second, &other, is_late); /* the file has changed */
    CHECK(!is_late || memcmp(&plan, &changed, sizeof plan));
    if (is_late) programs_stay(plan);
    ec_notes_write(case_cl(), r.name, "no plan", 8);
    (void)render(first, &expected, false);

    char word[4] = "", longer[8];
    ec_notes_write(case_cl(), "test", "abc", sizeof word);
    CHECK(ec_notes_read(case_cl(), "test", word, sizeof word) && !strcmp(word, "abc"));
    CHECK(!ec_notes_read(case_cl(), "test", longer, sizeof longer) && !ec_notes_read(case_cl(), "others", word, sizeof word));
    case_free(&expected);
    case_free(&other);
    TEST_END();
}
