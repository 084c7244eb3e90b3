/* The square of pixels around one, cut at the image's edges. */
#ifndef EC_FILM_NEIGHBOURHOOD_H
#define EC_FILM_NEIGHBOURHOOD_H

#include <stdint.h>

typedef struct ec_neighbourhood {
    uint32_t x0, x1, y0, y1; /* the ends excluded */
} ec_neighbourhood;

static inline ec_neighbourhood ec_neighbourhood_of(uint32_t x, uint32_t y, uint32_t radius, uint32_t width, uint32_t height)
{
    return (ec_neighbourhood){x < radius ? 0 : x - radius, width - x <= radius ? width : x + radius + 1,
                              y < radius ? 0 : y - radius, height - y <= radius ? height : y + radius + 1};
}

#endif
