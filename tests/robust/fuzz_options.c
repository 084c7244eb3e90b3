/* Options that the address sanitizer reads: an allocation whose size comes from a false header fails, as on a small machine. In a file of
 * its own: if this were weak, the sanitizer's definition, which clang links first, would win. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1:max_allocation_size_mb=64"; }
