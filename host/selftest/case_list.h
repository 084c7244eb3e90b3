/* Every case: CASE(name, is long, function, what breaks elsewhere where it fails). Short ones together take a few seconds, so that
 * whoever has a new device or driver runs them all. */
#ifndef EC_SELFTEST_CASE_LIST_H
#define EC_SELFTEST_CASE_LIST_H

#define EC_SELFTEST_CASES(CASE)                                                                                                    \
    CASE("transport/furnace", false, ec_selftest_furnace, "light lost or made at a bounce (Nori's test-furnace)")                  \
    CASE("transport/deep paths", false, ec_selftest_deep_paths, "throughput drifts over a thousand bounces, or paths end early")   \
    CASE("transport/roulette", false, ec_selftest_roulette, "roulette that divides by another probability than it plays")          \
    CASE("transport/mirrored plates", false, ec_selftest_mirrored_plates, "a lamp's images in mirrors counted twice or never met") \
    CASE("transport/corridor", false, ec_selftest_corridor, "smooth reflection that leaks or loses its direction")                 \
    CASE("transport/metal", false, ec_selftest_metal, "GGX with a wrong sign or denominator (Heitz 2014)")                         \
    CASE("lights/near lamp", false, ec_selftest_near_lamp, "1/d^2 explodes next to a lamp (Arvo 1995; pbrt's 3e-4 sr)")            \
    CASE("lights/tiny lamp", false, ec_selftest_tiny_lamp, "1 - cos of a small angle is 0: small lamps go out")                    \
    CASE("lights/facing squares", false, ec_selftest_facing_squares, "form factors (Siegel and Howell, C-11)")                     \
    CASE("lights/through the horizon", false, ec_selftest_horizon_lamp, "light from below the surface's own horizon")              \
    CASE("lights/back of a lamp", false, ec_selftest_lamp_back, "single-sided lamps that shine from both sides")                   \
    CASE("lights/all around", false, ec_selftest_surrounding_lamp, "lamps that fill the hemisphere")                               \
    CASE("lights/many", false, ec_selftest_many_lamps, "tables of lights whose probabilities are not those sampled")               \
    CASE("lights/occlusion", false, ec_selftest_occlusion, "shadow rays that miss a wall (ambient occlusion, closed form)")        \
    CASE("lights/punctual", false, ec_selftest_punctual, "units of glTF's lights")                                                 \
    CASE("environment/sun", false, ec_selftest_sun, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)")

#endif
