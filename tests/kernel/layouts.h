/* All offsets and sizes on which host and device must agree: L(SIZE, FIELD, NUMBER). test_layouts.c uses it on both sides. */
#ifndef EC_TESTS_KERNEL_LAYOUTS_H
#define EC_TESTS_KERNEL_LAYOUTS_H

#define LAYOUTS(S, F, N)                                                                           \
    S(ec_bvh2_node) F(ec_bvh2_node, lo) F(ec_bvh2_node, lo[1]) F(ec_bvh2_node, hi) F(ec_bvh2_node, hi[1][2])   \
    F(ec_bvh2_node, child) F(ec_bvh2_node, child[1])                                               \
    S(ec_tri) F(ec_tri, v0) F(ec_tri, id) F(ec_tri, v1) F(ec_tri, v2[2])                           \
    S(ec_bvh8_node) F(ec_bvh8_node, bound) F(ec_bvh8_node, bound[5][7]) F(ec_bvh8_node, child) F(ec_bvh8_node, child[7]) F(ec_bvh8_node, order) \
    S(ec_tri8) F(ec_tri8, v) F(ec_tri8, v[1]) F(ec_tri8, v[2][2][7]) F(ec_tri8, id)                \
    S(ec_box) F(ec_box, lo) F(ec_box, hi[2]) S(ec_box8) F(ec_box8, lo[1]) F(ec_box8, hi[2][7])     \
    S(ec_instance) F(ec_instance, inverse) F(ec_instance, id) F(ec_instance, root) F(ec_instance, turned) F(ec_instance, longest) F(ec_instance, reach) \
    S(ec_place_header) F(ec_place_header, first_id) F(ec_place_header, ids) F(ec_place_header, step)                      \
    S(ec_place) F(ec_place, normal) F(ec_place, id) F(ec_place, first) F(ec_place, turned)         \
    S(ec_params) F(ec_params, camera_origin) F(ec_params, camera_right) F(ec_params, camera_up) F(ec_params, camera_forward) \
    F(ec_params, environment) F(ec_params, environment_mean) F(ec_params, orthographic) F(ec_params, width) F(ec_params, height) F(ec_params, batch) \
    F(ec_params, wave) F(ec_params, part) F(ec_params, max_depth) F(ec_params, sample) F(ec_params, light_count)    \
    F(ec_params, environment_width) F(ec_params, environment_height) F(ec_params, environment_pmf) \
    F(ec_params, scene_radius) F(ec_params, scene_max) F(ec_params, first_roulette) F(ec_params, survival) F(ec_params, cutoff) F(ec_params, light_tree_numbers) F(ec_params, light_choices) F(ec_params, environment_stretch[1]) F(ec_params, far_numbers) F(ec_params, lamp_scale) F(ec_params, screen[3])                                            \
    S(ec_counters) F(ec_counters, at[1].rays) F(ec_counters, at[EC_SEGMENT].rays) F(ec_counters, at[1].shadows)   \
    S(ec_prim) F(ec_prim, v0) F(ec_prim, material) F(ec_prim, v1) F(ec_prim, light_pdf_a) F(ec_prim, v2) F(ec_prim, flags) \
    S(ec_texture_slot) F(ec_texture_slot, texture) F(ec_texture_slot, uv_set) F(ec_texture_slot, transform) \
    S(ec_material_data) F(ec_material_data, base_color) F(ec_material_data, emission) F(ec_material_data, flags) \
    F(ec_material_data, metallic) F(ec_material_data, roughness) F(ec_material_data, normal_scale) \
    F(ec_material_data, alpha_cutoff) F(ec_material_data, f0) F(ec_material_data, specular) \
    F(ec_material_data, absorption) F(ec_material_data, transmission) F(ec_material_data, ior) F(ec_material_data, coat_normal_scale) \
    F(ec_material_data, slots) F(ec_material_data, slots[EC_SLOT_COUNT - 1].transform[5])          \
    S(ec_texture_data) F(ec_texture_data, offset) F(ec_texture_data, width) F(ec_texture_data, height) F(ec_texture_data, flags) \
    S(ec_light_data) F(ec_light_data, a) F(ec_light_data, b) F(ec_light_data, c) F(ec_light_data, emission) \
    F(ec_light_data, kind) F(ec_light_data, prim) F(ec_light_data, pmf) F(ec_light_data, pdf_a)    \
    S(ec_lamp_node) F(ec_lamp_node, first[2]) F(ec_lamp_node, link)                                \
    S(ec_distribution_entry) F(ec_distribution_entry, first) F(ec_distribution_entry, guide)       \
    N(EC_PARTS) N(EC_PART_STRIDE) N(EC_STAGE_COUNT) N(EC_SLOT_COUNT) N(EC_KIND_ENVIRONMENT) N(EC_NO_ID) N(EC_LEAF_BIT)

#endif
