/* The buffers that a traversal is given, and its counts: with PROBE defined kernels also write the hit's t, the number of nodes or cells that the ray
 * visited and of triangles that it was tested against. For `eclat info --accel` and the tests; elsewhere it costs nothing. */
#ifndef EC_LIB_TALLY_H
#define EC_LIB_TALLY_H

#include "../shared/accel.h"

/* The accelerator's buffers, in the order in which its builder wrote them. */
typedef struct accel {
    global const void *at[EC_ACCEL_BUFFERS];
} accel;
#define ACCEL_PARAMETERS(DO)                                                                                                                          \
    DO(global const uint *, accel0) DO(global const uint *, accel1) DO(global const uint *, accel2) DO(global const uint *, accel3)                   \
    DO(global const uint *, accel4)
#define ACCEL_ARGUMENTS {{accel0, accel1, accel2, accel3, accel4}}

#ifdef PROBE
#define TALLIES uint nodes, tests;
#define TALLY_NODE(h) ((h)->nodes++)
#define TALLY_TESTS(h, n) ((h)->tests += (n))
#else
#define TALLIES
#define TALLY_NODE(h) ((void)0)
#define TALLY_TESTS(h, n) ((void)0)
#endif

#endif
