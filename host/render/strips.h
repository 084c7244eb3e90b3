/* A picture that does not fit into memory is rendered in strips of whole rows, one after the other from the top: each takes all its batches
 * before the next one begins. A sample depends on seed, pixel and number alone, so that strips make no difference to it. */
#ifndef EC_RENDER_STRIPS_H
#define EC_RENDER_STRIPS_H

#include "render/render.h"

/* Rows that strips are cut at: whole tiles (kernels/lib/film.h), and what an EXR compresses together. */
#define EC_STRIP_STEP 16u

/* Bytes of memory that grow with pixels, beside the scene. */
typedef struct ec_strip_need {
    uint64_t host, device;  /* a pixel: sums of batches and first-hit features; of the batch under way both again, which the host looks at where they
                               are: the device's too where that has memory of its own, and else only the host's */
    uint64_t column;        /* of the host for each pixel of the picture's width: bands on their way to the files */
} ec_strip_need;
ec_strip_need ec_strip_needs(const ec_render_options *options);

/* All that a picture takes of the host with one device. */
uint64_t ec_strip_whole(const ec_render_options *options);

/* Bytes with these devices together, and so many peers. */
uint64_t ec_strip_whole_for(const ec_render_options *options, const ec_device_info *devices, uint32_t count, uint32_t peers);

/* What pictures take that do not ask how much there is. */
#define EC_STRIP_NEVER (64ull << 20)

/* Bytes of the lowest strip. */
uint64_t ec_strip_least(const ec_render_options *options);

/* Fails with one line: a picture that is to be whole does not fit. whole_for: why it is; instead: what lets it be rendered in strips. */
ec_result ec_strip_refuse(const ec_render_options *options, uint64_t whole, int64_t budget, const char *whole_for,
                          const char *instead, ec_error *err);

/* How many rows fit at a time: all of them or a multiple of EC_STRIP_STEP; 0: not even one step. `host`: bytes that pixels may take; device, largest: the same of a device that has memory of its own, in all and in one piece. */
uint32_t ec_strip_rows(const ec_render_options *options, bool shared, int64_t host, uint64_t device, uint64_t largest);

/* Budget: of the memory that options allow, or of what is free, the bytes that pixels may take beside what the process has now and what it will take
 * whatever the picture (`coming`); negative where that is too much already. */
int64_t ec_strip_budget(const ec_render_options *options, uint64_t coming);

#endif
