/* How long things may take so that the picture follows the hand. */
#ifndef EC_VIEW_SLICE_H
#define EC_VIEW_SLICE_H

#define EC_VIEW_SLICE 0.02    /* seconds of a wave: the longest wait for an answer to a wish */
#define EC_VIEW_FOLLOWS 0.025 /* seconds of a picture while the camera moves */
#define EC_VIEW_COARSEST 16u  /* pixels of a side for a sample */

#endif
