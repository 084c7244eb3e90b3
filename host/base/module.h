/* Parts of the library that need libraries which most users do without: loaded when they are used. */
#ifndef EC_BASE_MODULE_H
#define EC_BASE_MODULE_H

#include "base/error.h"

/* Loads eclat-NAME.so, beside the library or in the folder eclat there, and sets *symbol to its `EC_MODULE_SYMBOL`, which lives as long as the
 * process. remedy: how to get one that is not there, for the message. */
ec_result ec_module_load(const char *name, const char *remedy, const void **symbol, ec_error *err);

/* Path (PATH_MAX) of a file that comes with the program: beside it, or where modules are installed. */
ec_result ec_module_find(const char *file, char *path, ec_error *err);

#define EC_MODULE_SYMBOL ec_module
#define EC_MODULE_EXPORT __attribute__((visibility("default")))

#endif
