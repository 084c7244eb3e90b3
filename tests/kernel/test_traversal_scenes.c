/* tier: full */
/* The same hits from every accelerator, on a number of rays for every day. See traversal_scenes.h. */
#include "kernel/traversal_scenes.h"

int main(void) { return check_scenes(50000); }
