/* tier: long */
/* Every accelerator gives the same hits, with ten million rays in each scene. */
#include "kernel/traversal_scenes.h"

int main(void) { return check_scenes(10000000); }
