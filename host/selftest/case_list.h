/* Every case: CASE(name, is long, function, what breaks elsewhere where it fails). A case is here if a device or its driver may fail it; short ones
 * together take a few seconds, so that whoever has a new one runs them all. Proofs of formulas and algorithms in the same form are in
 * tests/robust (cases.h). */
#ifndef EC_SELFTEST_CASE_LIST_H
#define EC_SELFTEST_CASE_LIST_H

#define EC_SELFTEST_CASES(CASE)                                                                                                    \
    CASE("transport/furnace", false, ec_selftest_furnace, "light lost or made at a bounce (Nori's test-furnace)")                  \
    CASE("transport/deep paths", false, ec_selftest_deep_paths, "throughput drifts over a thousand bounces, or paths end early")   \
    CASE("transport/roulette", false, ec_selftest_roulette, "roulette that divides by another probability than it plays")          \
    CASE("transport/mirrored plates", false, ec_selftest_mirrored_plates, "a lamp's images in mirrors counted twice or never met") \
    CASE("transport/corridor", false, ec_selftest_corridor, "smooth reflection that leaks or loses its direction")                 \
    CASE("transport/metal", false, ec_selftest_metal, "GGX with a wrong sign or denominator (Heitz 2014)")                         \
    CASE("rays/self-intersection", false, ec_selftest_self_intersection, "black dots and rings where surfaces shade themselves")   \
    CASE("rays/watertight", false, ec_selftest_watertight, "pinholes at edges and vertices (Woop et al. 2013; embree#387)")        \
    CASE("rays/nested balls", false, ec_selftest_nested, "what lies just under a surface shows through it")                        \
    CASE("rays/smooth leak", false, ec_selftest_smooth_leak, "light through a surface whose bent normal decides the side")         \
    CASE("rays/frame", false, ec_selftest_frame, "a frame that is singular at -z (Frisvad 2012; Duff et al. 2017)")                \
    CASE("rays/lane widths", true, ec_selftest_lane_widths, "pictures that depend on the width of a vector")                       \
    CASE("rays/accelerators", true, ec_selftest_accelerators, "pictures that depend on the acceleration structure")                \
    CASE("rays/instances", true, ec_selftest_instances, "meshes kept once that shade otherwise than written out")                  \
    CASE("lights/near lamp", false, ec_selftest_near_lamp, "1/d^2 explodes next to a lamp (Arvo 1995; pbrt's 3e-4 sr)")            \
    CASE("lights/tiny lamp", false, ec_selftest_tiny_lamp, "1 - cos of a small angle is 0: small lamps go out")                    \
    CASE("lights/facing squares", false, ec_selftest_facing_squares, "form factors (Siegel and Howell, C-11)")                     \
    CASE("lights/through the horizon", false, ec_selftest_horizon_lamp, "light from below the surface's own horizon")              \
    CASE("lights/back of a lamp", false, ec_selftest_lamp_back, "single-sided lamps that shine from both sides")                   \
    CASE("lights/all around", false, ec_selftest_surrounding_lamp, "lamps that fill the hemisphere")                               \
    CASE("lights/many", false, ec_selftest_many_lamps, "tables of lights whose probabilities are not those sampled")               \
    CASE("lights/occlusion", false, ec_selftest_occlusion, "shadow rays that miss a wall (ambient occlusion, closed form)")        \
    CASE("lights/punctual", false, ec_selftest_punctual, "units of glTF's lights")                                                 \
    CASE("lights/panes", true, ec_selftest_panes, "points and suns that light nothing behind a window")                            \
    CASE("camera/lens", false, ec_selftest_lens, "blur of another width than the thin lens's")                                    \
    CASE("environment/sun", false, ec_selftest_sun, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)")             \
    CASE("scatter/fresnel", false, ec_selftest_fresnel, "black or bright rims where total reflection sets in")                     \
    CASE("scatter/ggx", false, ec_selftest_ggx, "narrow lobes from 1 - cos^2: no digit is left at roughness 0.01")      \
    CASE("scatter/chi-square", false, ec_selftest_chi_square, "sampled otherwise than divided by")                                 \
    CASE("scatter/fuzz", false, ec_selftest_fuzz, "NaN and fireflies")                                                             \
    CASE("scatter/fuzz, layers", true, ec_selftest_fuzz_layers, "NaN and fireflies where effects meet")                            \
    CASE("scatter/slab", false, ec_selftest_slabs, "glass that darkens or brightens what is behind it")                            \
    CASE("scatter/nested glass", false, ec_selftest_nested_glass, "black glass: paths lost at faces or by depth")                  \
    CASE("numbers/arithmetic", false, ec_selftest_arithmetic, "cracks between triangles: products contracted (half of all)") \
    CASE("numbers/functions", false, ec_selftest_functions, "directions off the sphere")                                           \
    CASE("numbers/not finite", false, ec_selftest_not_finite, "tests for NaN folded away: black pixels that nobody counts")        \
    CASE("numbers/mis weights", false, ec_selftest_mis_weights, "a^2 overflows at 1.8e19: light lost or NaN (Mitsuba 3 zeroes it)")\
    CASE("numbers/roulette", false, ec_selftest_survival, "fireflies from dim paths that survive too often")                       \
    CASE("numbers/random", false, ec_selftest_random, "numbers of 1 (30 a second), patterns between pixels")             \
    CASE("numbers/sums", false, ec_selftest_sums, "pictures that darken with more samples: float sums (-58 % at 1e8)")             \
    CASE("numbers/range", false, ec_selftest_range, "suns that turn black: sums over 3.4e38")                                      \
    CASE("numbers/srgb", false, ec_selftest_srgb, "washed-out textures: gamma 2.2 for sRGB")                    \

#endif
