/* tier: full */
/* Every accelerator gives the same hits, on a number of rays for every day. See traversal_scenes.h. */
#include "kernel/traversal_scenes.h"

int main(void) { return check_scenes(20000); }
