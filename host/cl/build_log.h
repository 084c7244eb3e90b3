/* Shows and keeps a compiler's output. Inside host/cl only. */
#ifndef EC_CL_BUILD_LOG_H
#define EC_CL_BUILD_LOG_H

#include "cl/cl.h"

/* Returns the log of a program's last build; malloc'ed, NULL if there is none. */
char *ec_build_log(const ec_cl *cl, cl_program program);

/* Fails with "kernels LABEL do not compile…" and the first lines of the log, those with an error first; places are those that #line names. */
ec_result ec_build_log_fail(const ec_cl *cl, const char *label, const char *source, const char *log, cl_int code, ec_error *err);

/* Returns whether ECLAT_DUMP_KERNELS=DIR is set: then source goes to DIR/label.cl, the log to DIR/label.log. */
bool ec_build_log_wanted(void);
ec_result ec_build_log_dump(const char *label, const char *source, const char *options, const char *log, ec_error *err);

#endif
