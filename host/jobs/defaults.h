/* Defaults of options, and the limits that help states. */
#ifndef EC_JOBS_DEFAULTS_H
#define EC_JOBS_DEFAULTS_H

#define EC_DEFAULT_SPP 256      /* samples per pixel when none of --spp, --time and --error is given */
#define EC_DEFAULT_HEIGHT 512   /* pixels; the width follows the camera's aspect ratio */
#define EC_LIVE_HEIGHT 600      /* pixels in live sessions, likewise */
#define EC_BLUR 10              /* degrees of a blurred background */
#define EC_BLUR_LEAST 0.5
#define EC_BLUR_MOST 60
#define EC_DEFAULT_EVERY 60     /* seconds between two checkpoints */
#define EC_DEFAULT_BUDGET 120   /* seconds of `eclat cost` */
#define EC_COST_HEIGHT 256      /* pixels in `eclat cost`: as errors are per pixel, few pixels tell as much as many */
#define EC_MAX_SPP 16777216     /* 2^24: counts up to here are exact in the EXR's float channel */
#define EC_SAFETY_SPP 1048576   /* 2^20: limit of renders that only --time or --error would end */
#define EC_MAX_DEPTH 65535
#define EC_DEFAULT_CUTOFF 0.001 /* a quarter of the least step of an 8-bit picture */
#define EC_CLAMP_LEAST 0.001
#define EC_CLAMP_MOST 1000000
#define EC_FILTER_WIDTH_LEAST 0.1
#define EC_FILTER_WIDTH_MOST 10
#define EC_FSTOP_LEAST 0.001
#define EC_FSTOP_MOST 1000000
#define EC_FOCUS_LEAST 1e-6
#define EC_FOCUS_MOST 1e12
#define EC_DEFAULT_FPS 24
#define EC_FPS_LEAST 0.001
#define EC_FPS_MOST 100000
#define EC_FOV_LEAST 0.001       /* degrees */
#define EC_FOV_MOST 179
#define EC_POINT_SIZE_LEAST 0.01  /* pixels */
#define EC_POINT_SIZE_MOST 512
#define EC_GRID_DENSITY_LEAST 0.01
#define EC_GRID_DENSITY_MOST 10000

#define EC_EXPOSURE_HELP "brighten pictures for the screen by this many stops; auto shows the log-average luminance of what is not black as 0.18"

#define EC_TEXT_(x) #x
#define EC_TEXT(x) EC_TEXT_(x)

#endif
