/* A picture that does not fit into memory is rendered in strips of whole rows, one after the other from the top: each takes all its batches
 * before the next one begins. A sample depends on seed, pixel and number alone, so that strips make no difference to it. */
#ifndef EC_RENDER_STRIPS_H
#define EC_RENDER_STRIPS_H

#include "render/render.h"

/* Strips are cut at multiples of so many rows: whole tiles (kernels/lib/film.h), and what an EXR compresses together. */
#define EC_STRIP_STEP 16u

/* Bytes of memory that grow with pixels, beside the scene. */
typedef struct ec_strip_need {
    uint64_t host, device;  /* a pixel: sums of batches and first-hit features; both again for the batch under way, which the host reads in place: in
                             * the device's memory if it has its own, else in the host's */
    uint64_t column;        /* of the host, for each pixel of the picture's width: bands on their way to the files */
} ec_strip_need;
ec_strip_need ec_strip_needs(const ec_render_options *options);

/* Returns the host memory that a whole picture takes with one device, in bytes. */
uint64_t ec_strip_whole(const ec_render_options *options);

/* Returns the bytes with these devices together, and so many peers. */
uint64_t ec_strip_whole_for(const ec_render_options *options, const ec_device_info *devices, uint32_t count, uint32_t peers);

/* Pictures up to so many bytes do not ask how much memory there is. */
#define EC_STRIP_NEVER (64ull << 20)

/* Returns the bytes of the lowest strip. */
uint64_t ec_strip_least(const ec_render_options *options);

/* Fails with one line: a picture that is to be whole does not fit. whole_for: why it must be whole; instead: what lets it be rendered in strips. */
ec_result ec_strip_refuse(const ec_render_options *options, uint64_t whole, int64_t budget, const char *whole_for,
                          const char *instead, ec_error *err);

/* Returns how many rows fit at a time: all of them or a multiple of EC_STRIP_STEP; 0: not even one step. `host`: bytes that pixels may take; device,
 * largest: likewise for a device that has memory of its own, in all and in one piece. */
uint32_t ec_strip_rows(const ec_render_options *options, bool shared, int64_t host, uint64_t device, uint64_t largest);

/* Returns the bytes that pixels may take, of the memory that options allow or of what is free, beside what the process has now and what it will take
 * whatever the picture (`coming`); negative if that is too much already. */
int64_t ec_strip_budget(const ec_render_options *options, uint64_t coming);

#endif
