/* Runs the stage alone, for test_splat.c. */
#include "../../kernels/stages/splat.cl"
