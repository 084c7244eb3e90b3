/* The stage alone, over radiance that the test makes. */
#include "stages/accumulate.cl"
