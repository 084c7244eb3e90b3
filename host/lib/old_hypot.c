/* glibc 2.35 introduced a new version of hypot with the same values. With the old one, a library that is built with it runs with glibc 2.34 too, as
 * on RHEL 9. The linker replaces hypot by this function: --wrap in CMakeLists.txt. */
#include <features.h>

#if defined(__x86_64__) && defined(__GLIBC__)
double ec_old_hypot(double a, double b);
__asm__(".symver ec_old_hypot,hypot@GLIBC_2.2.5");
double __wrap_hypot(double a, double b);
double __wrap_hypot(double a, double b) { return ec_old_hypot(a, b); }
#endif
