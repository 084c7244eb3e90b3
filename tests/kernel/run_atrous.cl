/* The stage alone, over a picture that the test makes. */
#include "stages/atrous.cl"
