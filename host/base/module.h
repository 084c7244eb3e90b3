/* Parts of the library that need libraries which most users do without: they are loaded when used. */
#ifndef EC_BASE_MODULE_H
#define EC_BASE_MODULE_H

#include "base/error.h"

/* Loads eclat-NAME.so, from the library's folder or its subfolder eclat, and sets *symbol to its `EC_MODULE_SYMBOL`, which lives as long as the
 * process. remedy: how to obtain a missing module, for the message. */
ec_result ec_module_load(const char *name, const char *remedy, const void **symbol, ec_error *err);

/* Finds a file that comes with the program, beside it or where modules are installed. path: PATH_MAX bytes. */
ec_result ec_module_find(const char *file, char *path, ec_error *err);

#define EC_MODULE_SYMBOL ec_module
#define EC_MODULE_EXPORT __attribute__((visibility("default")))

#endif
