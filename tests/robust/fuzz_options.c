/* Read by the address sanitizer: an allocation that a header's claim makes large fails, as it would on a small machine. In a file of its own,
 * since where this were weak the sanitizer's own, which clang links first, would win. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1:max_allocation_size_mb=64"; }
