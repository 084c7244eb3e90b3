/* Measures times between frames of the window while the camera moves. */
#ifndef EC_VIEW_FRAMES_H
#define EC_VIEW_FRAMES_H

#include <stdint.h>
#include <stdio.h>

enum { EC_FRAMES_MOST = 65536 };
typedef struct ec_frames {
    double *seconds; /* owned */
    uint32_t count;
    double last;     /* time of the last frame; 0: it does not count */
    uint64_t first_picture, pictures;
} ec_frames;

/* Records that a frame appeared on the screen at `now` seconds. moving: it counts; pictures: number shown since the start. */
void ec_frames_add(ec_frames *frames, double now, int moving, uint64_t pictures);
void ec_frames_print(const ec_frames *frames, double first_light, FILE *to);
void ec_frames_free(ec_frames *frames);

#endif
