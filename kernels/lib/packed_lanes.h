/* Packs those of eight lanes that are on, on processors that permute eight lanes by a vector of numbers. */
#ifndef EC_LIB_PACKED_LANES_H
#define EC_LIB_PACKED_LANES_H

#include "../shared/types.h"

#ifndef __has_builtin
#define __has_builtin(x) 0
#endif

#ifndef PERMUTES_LANES /* tests build with 0 to stand for processors that do not */
#if defined(__AVX2__) && __has_builtin(__builtin_ia32_permvarsi256)
#define PERMUTES_LANES 1
#else
#define PERMUTES_LANES 0
#endif
#endif

#if PERMUTES_LANES
/* For each mask, the numbers of the lanes that are on, in their order: an octal digit each, from the last digit on. */
constant uint packed_lanes[256] = {
    0, 0, 01, 010, 02, 020, 021, 0210, 03, 030, 031, 0310, 032, 0320, 0321, 03210,
    04, 040, 041, 0410, 042, 0420, 0421, 04210, 043, 0430, 0431, 04310, 0432, 04320, 04321, 043210,
    05, 050, 051, 0510, 052, 0520, 0521, 05210, 053, 0530, 0531, 05310, 0532, 05320, 05321, 053210,
    054, 0540, 0541, 05410, 0542, 05420, 05421, 054210, 0543, 05430, 05431, 054310, 05432, 054320, 054321, 0543210,
    06, 060, 061, 0610, 062, 0620, 0621, 06210, 063, 0630, 0631, 06310, 0632, 06320, 06321, 063210,
    064, 0640, 0641, 06410, 0642, 06420, 06421, 064210, 0643, 06430, 06431, 064310, 06432, 064320, 064321, 0643210,
    065, 0650, 0651, 06510, 0652, 06520, 06521, 065210, 0653, 06530, 06531, 065310, 06532, 065320, 065321, 0653210,
    0654, 06540, 06541, 065410, 06542, 065420, 065421, 0654210, 06543, 065430, 065431, 0654310, 065432, 0654320, 0654321, 06543210,
    07, 070, 071, 0710, 072, 0720, 0721, 07210, 073, 0730, 0731, 07310, 0732, 07320, 07321, 073210,
    074, 0740, 0741, 07410, 0742, 07420, 07421, 074210, 0743, 07430, 07431, 074310, 07432, 074320, 074321, 0743210,
    075, 0750, 0751, 07510, 0752, 07520, 07521, 075210, 0753, 07530, 07531, 075310, 07532, 075320, 075321, 0753210,
    0754, 07540, 07541, 075410, 07542, 075420, 075421, 0754210, 07543, 075430, 075431, 0754310, 075432, 0754320, 0754321, 07543210,
    076, 0760, 0761, 07610, 0762, 07620, 07621, 076210, 0763, 07630, 07631, 076310, 07632, 076320, 076321, 0763210,
    0764, 07640, 07641, 076410, 07642, 076420, 076421, 0764210, 07643, 076430, 076431, 0764310, 076432, 0764320, 0764321, 07643210,
    0765, 07650, 07651, 076510, 07652, 076520, 076521, 0765210, 07653, 076530, 076531, 0765310, 076532, 0765320, 0765321, 07653210,
    07654, 076540, 076541, 0765410, 076542, 0765420, 0765421, 07654210, 076543, 0765430, 0765431, 07654310, 0765432, 07654320, 07654321, 076543210,
};

/* Spreads eight lane numbers, an octal digit each; permute8 ignores all other bits. */
EC_INLINED int8 lanes8_spread(uint digits) { return as_int8((uint8)(digits) >> (uint8)(0, 3, 6, 9, 12, 15, 18, 21)); }

/* Lane k of the result is lane `lanes[k] & 7` of v. */
EC_INLINED int8 permute8(int8 v, int8 lanes) { return __builtin_ia32_permvarsi256(v, lanes); }

/* Packs the lanes of `mask` to the front. */
EC_INLINED int8 pack8(int8 v, uint mask)
{
#if defined(__AVX512VL__) && __has_builtin(__builtin_ia32_compresssi256_mask)
    return __builtin_ia32_compresssi256_mask(v, (int8)(0), (uchar)mask);
#else
    return permute8(v, lanes8_spread(packed_lanes[mask]));
#endif
}
#endif

#endif
