/* Inputs of the precision cases; kernel_*.h describe the words. */
#ifndef EC_PRECISION_INPUTS_H
#define EC_PRECISION_INPUTS_H

#include "robust/precision/internal.h"

typedef void ec_precision_inputs(uint64_t *random, float *x);

/* inputs.c: numbers, vectors, directions */
ec_precision_inputs ec_inputs_turn, ec_inputs_exponent, ec_inputs_logarithm, ec_inputs_plane, ec_inputs_two_vectors,
    ec_inputs_vector, ec_inputs_colour, ec_inputs_direction, ec_inputs_two_directions, ec_inputs_densities,
    ec_inputs_share, ec_inputs_distance, ec_inputs_phase, ec_inputs_free_way, ec_inputs_fog;

/* inputs_bsdf.c */
ec_precision_inputs ec_inputs_interface, ec_inputs_refraction, ec_inputs_opaque, ec_inputs_into_glass, ec_inputs_off_glass,
    ec_inputs_thin, ec_inputs_smooth_glass, ec_inputs_highlight, ec_inputs_half_vector, ec_inputs_film, ec_inputs_dispersion,
    ec_inputs_into_brushed_glass, ec_inputs_off_brushed_glass, ec_inputs_brushed_half_vector;

/* inputs_scene.c: triangles, lights, maps, the camera */
ec_precision_inputs ec_inputs_hit, ec_inputs_mapped_hit, ec_inputs_values, ec_inputs_offset, ec_inputs_box, ec_inputs_triangle,
    ec_inputs_light, ec_inputs_spot, ec_inputs_patch, ec_inputs_sample, ec_inputs_texture, ec_inputs_slot, ec_inputs_edge;

#endif
