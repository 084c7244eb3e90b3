/* The denoisers that --denoise chooses from. */
#ifndef EC_FILM_DENOISER_H
#define EC_FILM_DENOISER_H

typedef enum ec_denoiser {
    EC_DENOISER_NONE,
    EC_DENOISER_AUTO,  /* Open Image Denoise where it is installed, else the filter of eclat's own */
    EC_DENOISER_OIDN,
    EC_DENOISER_ATROUS
} ec_denoiser;

extern const char *const ec_denoiser_names[]; /* as --denoise has them, with NULL at the end */

#endif
