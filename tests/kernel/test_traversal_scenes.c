/* tiers: full, long */
/* Every accelerator gives the same hits, with a number of rays for daily use. See traversal_scenes.h. */
#include "kernel/traversal_scenes.h"

int main(void) { return check_scenes(test_tier("long") ? 50000 : 20000); }
