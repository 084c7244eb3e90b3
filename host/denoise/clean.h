/* Makes the clean picture from two denoised halves: denoised, best, and how far each is from the truth. */
#ifndef EC_DENOISE_CLEAN_H
#define EC_DENOISE_CLEAN_H

#include "denoise/judge.h"

/* The result of denoising. */
typedef struct ec_denoised {
    const char *why_not;           /* why there is none, in words; NULL: it is there */
    ec_stated_error clean, best;   /* errors of the denoised picture, and of the best one, which takes from each what is nearer to the truth */
    double noise, bias;            /* of the denoised picture: its squared error is the sum of their squares */
    double noisy;                  /* error of the picture itself, for comparison */
    uint32_t tiles, nearer, off;   /* number of tiles, of 16 x 16 pixels; those where the denoised picture is nearer to the truth; those where the
                                    * best one takes next to nothing of it */
    uint32_t off_x, off_y;         /* the middle of the tile among these that the denoiser would harm most */
    double seconds;
    char library[32];              /* "Open Image Denoise 2.5.1" */
} ec_denoised;

/* half: the two halves of ec_half, denoised. into: room for all three planes. Leaves `library` and `seconds` of *out as they are. */
ec_result ec_clean_make(const ec_film *film, const float *const half[2], const ec_film_error *noisy, const ec_film_clean *into, ec_denoised *out,
                        ec_error *err);

#endif
