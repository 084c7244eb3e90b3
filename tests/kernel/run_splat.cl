/* The stage by itself, for test_splat.c. */
#include "../../kernels/stages/splat.cl"
