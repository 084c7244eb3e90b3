/* Every case: CASE(name, is long, function, what breaks elsewhere where it fails). A case is here if a device or its driver may fail it; short ones
 * together take a few seconds, so that whoever has a new one runs them all. Proofs of formulas and algorithms in the same form are in
 * tests/robust (cases.h). */
#ifndef EC_SELFTEST_CASE_LIST_H
#define EC_SELFTEST_CASE_LIST_H

#define EC_SELFTEST_CASES(CASE)                                                                                                  \
    CASE("transport/furnace", false, ec_selftest_furnace, "light lost or made at a bounce (Nori's test-furnace)")                \
    CASE("transport/metal", false, ec_selftest_metal, "GGX with a wrong sign or denominator (Heitz 2014)")                       \
    CASE("rays/watertight", false, ec_selftest_watertight, "pinholes at edges and vertices (Woop et al. 2013; embree#387)")      \
    CASE("rays/nested balls", false, ec_selftest_nested, "what lies just under a surface shows through it")                      \
    CASE("rays/lane widths", true, ec_selftest_lane_widths, "pictures that depend on the width of a vector")                     \
    CASE("rays/accelerators", true, ec_selftest_accelerators, "pictures that depend on the acceleration structure")              \
    CASE("lights/facing squares", false, ec_selftest_facing_squares, "form factors (Siegel and Howell, C-11)")                   \
    CASE("lights/punctual", false, ec_selftest_punctual, "units of glTF's lights")                                               \
    CASE("environment/sun", false, ec_selftest_sun, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)")           \
    CASE("scatter/slab", false, ec_selftest_slabs, "glass that darkens or brightens what is behind it")                          \
    CASE("scatter/nested glass", false, ec_selftest_nested_glass, "black glass: paths lost at faces or by depth")                \
    CASE("numbers/arithmetic", false, ec_selftest_arithmetic, "cracks between triangles: products contracted (half of all)")     \
    CASE("numbers/functions", false, ec_selftest_functions, "directions off the sphere")                                         \
    CASE("numbers/not finite", false, ec_selftest_not_finite, "tests for NaN folded away: black pixels that nobody counts")      \
    CASE("numbers/random", false, ec_selftest_random, "other pictures than elsewhere, patterns between pixels")                  \
    CASE("numbers/sums", false, ec_selftest_sums, "pictures that darken with more samples: float sums (-58 % at 1e8)")

#endif
