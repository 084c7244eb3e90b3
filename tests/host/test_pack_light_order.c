/* tier: quick */
/* Order of lights in the table: the environment, then directional lights, then lamps, whose neighbours in the table are close in space. */
#include "pack/light_order.h"
#include "support/random.h"
#include "support/test.h"

enum { SIDE = 16, LAMPS = SIDE * SIDE, LIGHTS = LAMPS + 3 };

int main(void)
{
    static ec_light_data lights[LIGHTS];
    static double power[LIGHTS];
    static uint32_t source[LIGHTS];
    static bool seen[LIGHTS];
    test_random numbers = {1};
    ec_error err = {0};
    for (uint32_t i = 0; i < LIGHTS; i++) power[i] = source[i] = i;
    for (int i = 0; i < LAMPS; i++) { /* a grid, in an irregular order */
        const int place = i * 97 % LAMPS, at = place < LAMPS / 2 ? place : place + 1;
        ec_light_data *l = &lights[at];
        const float x = (float)(i % SIDE), z = (float)(i / SIDE);
        l->kind = i % 3 ? EC_KIND_POINT : EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED;
        l->a[0] = x, l->a[2] = z;
        l->b[0] = i % 3 ? 7.0f : x + 0.01f, l->b[2] = z; /* points have no area */
        l->c[0] = x, l->c[2] = z + 0.01f;
        l->pmf = (float)at;
    }
    lights[LAMPS / 2] = (ec_light_data){.kind = EC_KIND_DIRECTIONAL, .pmf = LAMPS / 2};
    lights[LAMPS + 1] = (ec_light_data){.kind = EC_KIND_DIRECTIONAL, .pmf = LAMPS + 1};
    lights[LAMPS + 2] = (ec_light_data){.kind = EC_KIND_ENVIRONMENT, .pmf = LAMPS + 2};
    CHECK_OK(ec_light_order(lights, power, source, LIGHTS, &err), err);
    CHECK(lights[0].kind == EC_KIND_ENVIRONMENT && lights[1].kind == EC_KIND_DIRECTIONAL && lights[2].kind == EC_KIND_DIRECTIONAL);
    CHECK(lights[1].pmf < lights[2].pmf);
    double way = 0, random_way = 0;
    for (int i = 0; i < LIGHTS; i++) {
        CHECK_MSG((double)lights[i].pmf == power[i] && source[i] == power[i] && !seen[(int)power[i]], "light %d came with the power of another", i);
        seen[(int)power[i]] = true;
        if (i < 4) continue;
        way += hypot((double)lights[i].a[0] - lights[i - 1].a[0], (double)lights[i].a[2] - lights[i - 1].a[2]) / (LAMPS - 1);
        random_way += hypot(floor(SIDE * test_uniform(&numbers)) - floor(SIDE * test_uniform(&numbers)),
                            floor(SIDE * test_uniform(&numbers)) - floor(SIDE * test_uniform(&numbers))) / (LAMPS - 1);
    }
    /* Morton's curve moves 1.7 cells a step on average over such a grid; random pairs are 8 apart. */
    CHECK_MSG(way < 2 && random_way > 6, "%.2f cells a step, of random pairs %.2f", way, random_way);
    CHECK_OK(ec_light_order(lights, power, source, 0, &err), err);
    TEST_END();
}
