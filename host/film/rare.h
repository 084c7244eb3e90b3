/* Light that hardly any sample meets: paths whose last direction light sampling cannot choose (a mirror's, glass's, the camera's own) and
 * whose light is so small that few of those directions lead to it. While a render expects only a handful of such samples it may have met
 * none: that light is missing, and the samples' spread says nothing of it. How often they come and what they bring is predicted by
 * rare/paths.h; here is what that means for an error.
 *
 * What is missing is an error of the size of that light, pixel by pixel: its root mean square. Once samples meet it, however few, they
 * tell of it themselves, in the variance of the pixels that they are in. */
#ifndef EC_FILM_RARE_H
#define EC_FILM_RARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define EC_RARE_KINDS 16
#define EC_RARE_TILES 16   /* the picture is cut in as many columns and rows */
#define EC_RARE_SHARES (EC_RARE_TILES * EC_RARE_TILES)
#define EC_RARE_NAME 48
#define EC_RARE_WAY (2 * EC_RARE_NAME + 32) /* room for ec_rare_way */
#define EC_RARE_MET 5.0    /* samples that a kind is expected to have once it is as good as met: 1 in 150 renders has none */
#define EC_RARE_LEAST 0.05 /* of the mean luminance without these samples, root mean square: missing light that matters where … */
#define EC_RARE_TAIL 0.5   /* … the largest few samples hold more than this share of the noise */
#define EC_RARE_DOUBT 2.0  /* by which what is predicted of its light may be too low */

/* One kind of path: through one material, with one sharpness, to one light. */
typedef struct ec_rare_kind {
    char through[EC_RARE_NAME], light[EC_RARE_NAME]; /* names for messages; through is empty where the camera sees the light itself */
    double chance; /* probability that a sample of the picture is such a path */
    double luminance; /* mean luminance that they bring to a pixel */
    bool is_relative; /* luminance is relative to the picture's mean: how bright a picture it makes is not known */
    double clamped;   /* share of it that a clamp of indirect light limits (film/clamp.h) */
    double caustic;   /* share of it that light paths could bring; 0 where they do */
    double gathered;  /* root mean square over pixels of what they bring, over the mean: 1 where it is even */
    uint8_t share[EC_RARE_SHARES]; /* of their light in each tile, row by row: 255 is the brightest tile's … */
    double peak;                   /* … which has so many times the mean tile's */
} ec_rare_kind;

typedef struct ec_rare {
    uint32_t count;
    uint32_t width, height; /* of the picture */
    uint32_t row;           /* the picture's that a film of some of its rows begins with */
    ec_rare_kind kinds[EC_RARE_KINDS];
} ec_rare;

/* Returns room for a kind that matters so much (luminance * gathered): a new one, or that of the kind that matters least; NULL if that one matters more. */
ec_rare_kind *ec_rare_make_room(ec_rare *rare, double matters);

/* Writes "through "glass" to "lamp"", or "straight to "lamp"" where nothing is passed through. */
void ec_rare_way(const char *through, const char *light, char *text, size_t size);

/* Returns the mean over pixels of the square of the luminance that is missing if kinds are not met of which so many samples (of the whole picture)
 * expect fewer than EC_RARE_MET; *most: the kind that matters most, or NULL. rare may be NULL. Means of kinds add up; their peaks are
 * taken to lie in different places. mean: the picture's luminance. limit: of a sample's indirect light, where the picture is clamped; else 0. */
double ec_rare_missing(const ec_rare *rare, double samples, double mean, double limit, const ec_rare_kind **most);

/* Returns the variance of a sample by what light paths could bring, over the square of the picture's mean luminance; *most: the kind with most of it,
 * or NULL. */
double ec_rare_caustics(const ec_rare *rare, double mean, const ec_rare_kind **most);

/* Returns the tile that a pixel of the picture lies in. */
uint32_t ec_rare_tile(const ec_rare *rare, uint32_t x, uint32_t y);

/* Returns the mean luminance of such kinds around a pixel, in a picture whose pixels all have as many samples; y: row of the film. */
double ec_rare_missing_at(const ec_rare *rare, double samples_a_pixel, double mean, double limit, uint32_t x, uint32_t y);

#endif
