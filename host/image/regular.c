#include <sys/stat.h>

#include "base/atomic_file.h"
#include "image/image.h"

ec_result ec_image_check_regular(const char *path, ec_error *err)
{
    struct stat info;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode)) return EC_OK;
    return ec_fail(err, "cannot read '%s': it is %s; give a file", path,
                   S_ISDIR(info.st_mode) ? "a folder" : "not a regular file");
}

ec_result ec_image_check_writable(const char *path, ec_error *err)
{
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));
    ec_atomic_abort(&file);
    return EC_OK;
}
