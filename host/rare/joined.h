/* How many light paths pay: by what the first look's paths gather of light that bends or is mirrored sharply on its way to what they see. */
#ifndef EC_RARE_JOINED_H
#define EC_RARE_JOINED_H

#include "rare/look.h"

enum { EC_JOINED_NUMBERS = 6 };

/* Luminance that one path has gathered. */
typedef struct ec_joined_path {
    float radiance, indirect;
    float saved[EC_JOINED_NUMBERS]; /* their squares are what numbers[k] light paths a camera path would take away of the square of indirect light */
    float area;  /* area of the picture where it first meets a surface, across the ray */
    float beta;  /* past that surface */
    bool by_segment, by_vertex; /* light that its segment meets, or that its vertex samples, is such light */
} ec_joined_path;

typedef struct ec_joined {
    double flux;           /* W, of luminance, that lights send to what bends or mirrors it sharply */
    float *rgb, *luminance; /* of a wave's slots; owned, as the next one */
    ec_joined_path *paths; /* NULL: not asked for */
} ec_joined;

/* Makes room for paths that come in pairs, two of a pixel. flux: 0 where this is not asked for. */
ec_result ec_joined_open(ec_joined *j, double flux, uint32_t paths, ec_error *err);
void ec_joined_close(ec_joined *j); /* zero-initialised or closed is fine */

/* Notes where a path, which leaves p with beta, first met a surface. */
void ec_joined_first(ec_joined_path *path, const ec_params *params, const float p[3], float beta);

/* Adds what the paths of the look's wave have gathered since the last call: by the segments that bounce `bounce` traced or, if not by_segment, by
 * light sampled where these end. */
ec_result ec_joined_gather(ec_joined *j, const ec_look *look, uint32_t bounce, bool by_segment, ec_error *err);

/* How many light paths for each camera path have the least error for the time. */
typedef struct ec_joined_choice {
    double number; /* 0: none pays */
    double share;  /* share of the variance that they take away */
    bool may;      /* they would pay if there were indirect light alone: then more paths should tell */
} ec_joined_choice;
ec_joined_choice ec_joined_choose(const ec_joined *j, uint32_t paths);

#endif
