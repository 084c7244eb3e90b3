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
    CASE("transport/metal", false, ec_selftest_metal, "GGX with a wrong sign or denominator (Heitz 2014)")

#endif
