/* A pixel filter as its samples' places: the inverse of its distribution, for device and host. */
#ifndef EC_SHARED_PIXEL_FILTER_H
#define EC_SHARED_PIXEL_FILTER_H

/* Entry k: how many pixels from the centre a sample lies whose random number is u = (k / EC_FILTER_STEPS)^4 / 2, the share of the
 * filter that lies further out on its side. Fourth roots, since tails are thin. */
#define EC_FILTER_STEPS 256
#define EC_FILTER_ENTRIES (EC_FILTER_STEPS + 1)

#endif
