/* Films of layers: each layer is a film of its own, of the same batches as the picture's, with means and standard errors made in the same way. */
#ifndef EC_FILM_LAYER_FILMS_H
#define EC_FILM_LAYER_FILMS_H

#include "film/film.h"

/* Creates empty layer films for a film that is empty. */
ec_result ec_film_set_layers(ec_film *film, const ec_layers *layers, ec_error *err);

/* Writes the batch of one layer, EC_BATCH_FIELDS a position, from floats of all layers of a film. */
void ec_film_layer_batch(const ec_film *film, uint32_t layer, const float *layers, uint64_t positions, float *batch);

/* A layer's values in a picture: mean R, G, B, their standard errors, and that of luminance. */
enum { EC_LAYER_PLANES = 7 };

/* Writes the layers of rows [first, first + rows), EC_LAYER_PLANES floats a layer and pixel. rgb: the picture's, 3 a pixel. Direct and indirect
 * light, and light groups, are moved by rounding errors so that they add up to it: as 32-bit floats, one after the other, bit for bit. */
void ec_film_resolve_layers(const ec_film *film, uint32_t first, uint32_t rows, const float *rgb, float *out);

/* Moves `count` numbers, `stride` floats apart, by as little as makes their sum `sum`. */
void ec_sum_to(float *numbers, uint32_t count, uint32_t stride, float sum);

#endif
