/* Runs the stage alone, over a picture made by the test. */
#include "stages/atrous.cl"
