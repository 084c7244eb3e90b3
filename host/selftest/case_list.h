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
    CASE("rays/self-intersection", false, ec_selftest_self_intersection, "black dots and rings where surfaces shade themselves")   \
    CASE("rays/gap", false, ec_selftest_gap, "light leaks through thin walls by offsets that are too long")                        \
    CASE("rays/watertight", false, ec_selftest_watertight, "pinholes at edges and vertices (Woop et al. 2013; embree#387)")        \
    CASE("rays/nested balls", false, ec_selftest_nested, "what lies just under a surface shows through it")                        \
    CASE("rays/box planes", false, ec_selftest_box_planes, "0 times infinity in slabs loses touched boxes (Williams et al. 2005)")\
    CASE("rays/ties", false, ec_selftest_ties, "coplanar faces flicker with the order of triangles")                               \
    CASE("rays/coincident triangles", false, ec_selftest_coincident, "builders that never end where triangles cannot be parted")   \
    CASE("rays/grazing", false, ec_selftest_grazing, "epsilons on the cosine or the determinant lose grazing hits")                \
    CASE("rays/slivers", false, ec_selftest_slivers, "needles shade with wild barycentrics (pbrt-v4's TEST(Triangle, BadCases))")  \
    CASE("rays/scale", false, ec_selftest_scale, "absolute epsilons: scenes in millimetres or kilometres break")                   \
    CASE("rays/translation", false, ec_selftest_translation, "scenes far from the origin lose their digits")                       \
    CASE("rays/turned", false, ec_selftest_turned, "mirrored nodes turn inside out")                                               \
    CASE("rays/baked coordinates", true, ec_selftest_baked, "what the file itself has lost of a scene far from the origin")        \
    CASE("rays/degenerate", false, ec_selftest_degenerate, "triangles without area or numbers that crash builders or shine")       \
    CASE("rays/singular nodes", false, ec_selftest_singular_nodes, "NaN normals below nodes that flatten")                         \
    CASE("rays/zero normals", true,  ec_selftest_zero_normals, "NaN from normals, tangents and normal maps of zeros")              \
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
    CASE("camera/shutter", true, ec_selftest_shutter, "things that stand still for some rays while they move for others")           \
    CASE("environment/sun", false, ec_selftest_sun, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)")             \
    CASE("environment/cube", false, ec_selftest_image_light, "image-based light mirrored, turned back to front, or seamed (EXT_lights_image_based)") \
    CASE("scatter/fresnel", false, ec_selftest_fresnel, "black or bright rims where total reflection sets in")                     \
    CASE("scatter/film", false, ec_selftest_film, "rainbows on films of nothing; black or bright rims")                            \
    CASE("scatter/ggx", false, ec_selftest_ggx, "narrow lobes from 1 - cos^2: no digit is left at roughness 0.01")                  \
    CASE("scatter/chi-square", false, ec_selftest_chi_square, "sampled otherwise than divided by")                                 \
    CASE("scatter/energy", false, ec_selftest_energy, "materials that glow")                                                       \
    CASE("scatter/multiple", true, ec_selftest_multiple, "rough metal and glass that darken, or glow")                            \
    CASE("scatter/reciprocity", false, ec_selftest_reciprocity, "a picture that depends on the side paths start from")             \
    CASE("scatter/fuzz", false, ec_selftest_fuzz, "NaN and fireflies")                                                             \
    CASE("scatter/fuzz, layers", true, ec_selftest_fuzz_layers, "NaN and fireflies where effects meet")                            \
    CASE("scatter/brushed", true, ec_selftest_brushed, "stretched lobes that glow, or that lose their digits across")             \
    CASE("scatter/coat", true, ec_selftest_coat, "lacquer that makes light, or goes black at its rim")                            \
    CASE("scatter/slab", false, ec_selftest_slabs, "glass that darkens or brightens what is behind it")                            \
    CASE("scatter/slab in slab", false, ec_selftest_slab_in_slab, "liquid in glass that refracts as if in air (Schmidt and Budge 2002)") \
    CASE("scatter/nested glass", false, ec_selftest_nested_glass, "black glass: paths lost at faces or by depth")                  \
    CASE("scatter/continuity", false, ec_selftest_continuity, "a jump in brightness where roughness gets to 0")                    \
    CASE("scatter/sheen", true, ec_selftest_sheen, "velvet that glows or goes black at its rim")                                   \
    CASE("scatter/diffuse transmission", true, ec_selftest_seeping, "leaves that lose light or shine on both sides")               \
    CASE("scatter/dispersion", true, ec_selftest_dispersion, "colours whose sum is not white (Cauchy's index by colour)")          \
    CASE("numbers/arithmetic", false, ec_selftest_arithmetic, "cracks between triangles: products contracted (half of all)")        \
    CASE("numbers/functions", false, ec_selftest_functions, "directions off the sphere")                                           \
    CASE("numbers/not finite", false, ec_selftest_not_finite, "tests for NaN folded away: black pixels that nobody counts")        \
    CASE("numbers/mis weights", false, ec_selftest_mis_weights, "a^2 overflows at 1.8e19: light lost or NaN (Mitsuba 3 zeroes it)")\
    CASE("numbers/roulette", false, ec_selftest_survival, "fireflies from dim paths that survive too often")                       \
    CASE("numbers/random", false, ec_selftest_random, "numbers of 1 (30 a second), patterns between pixels")                        \
    CASE("numbers/sums", false, ec_selftest_sums, "pictures that darken with more samples: float sums (-58 % at 1e8)")             \
    CASE("numbers/many samples", true, ec_selftest_many_samples, "pictures that darken with more samples: float sums (-58 % at 1e8)")\
    CASE("numbers/range", false, ec_selftest_range, "suns that turn black: sums over 3.4e38")                                      \
    CASE("numbers/variance", false, ec_selftest_variance, "errors stated as 0: E[x^2] - E[x]^2 cancels")                           \
    CASE("numbers/srgb", false, ec_selftest_srgb, "washed-out textures: gamma 2.2 for sRGB")                    \
    CASE("precision/float", true, ec_selftest_precision, "digits lost where numbers that were rounded cancel")

#endif
