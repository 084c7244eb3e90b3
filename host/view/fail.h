#ifndef EC_VIEW_FAIL_H
#define EC_VIEW_FAIL_H

#include <eclat/eclat.h>

/* ECLAT_FAILED, and why; err may be NULL. */
eclat_result ec_view_fail(eclat_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
