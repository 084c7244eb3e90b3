#include <sys/stat.h>

#include "image/image.h"

ec_result ec_image_check_regular(const char *path, ec_error *err)
{
    struct stat info;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode)) return EC_OK;
    return ec_fail(err, "cannot read '%s': it is %s; give a file", path,
                   S_ISDIR(info.st_mode) ? "a folder" : "not a regular file");
}
