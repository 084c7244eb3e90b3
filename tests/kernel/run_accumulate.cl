/* Runs the stage alone, over radiance made by the test. */
#include "stages/accumulate.cl"
