#include "image/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "image/image.h"

ec_result ec_write_failed(ec_error *err, const char *path, int error_number)
{
    const char *remedy = "choose another output path";
    switch (error_number) {
    case ENOENT:
    case ENOTDIR: remedy = "create its folder first or choose another output path"; break;
    case EACCES:
    case EPERM:
    case EROFS: remedy = "choose a file and folder that you may write to"; break;
    case ENOSPC:
    case EDQUOT:
    case EFBIG: remedy = "free some space or choose another disk"; break;
    }
    return ec_fail(err, "cannot write '%s': %s; %s", path, strerror(error_number), remedy);
}

/* Whatever stands at `path` now must be a regular file that we may write: renaming over a device such as /dev/null
 * would destroy it, and renaming over a read-only file would get round its owner's wish. */
static ec_result check_replaceable(const char *path, ec_error *err)
{
    struct stat info;
    if (stat(path, &info) != 0) return errno == ENOENT ? EC_OK : ec_write_failed(err, path, errno);
    if (S_ISDIR(info.st_mode)) return ec_fail(err, "cannot write '%s': it is a folder; give a file name", path);
    if (!S_ISREG(info.st_mode))
        return ec_fail(err, "cannot write '%s': it is not a regular file; give a file name", path);
    if (faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) != 0) return ec_write_failed(err, path, errno);
    return EC_OK;
}

/* open() rather than mkstemp(): the kernel applies the umask to 0666, which a library cannot read without changing it
 * for the whole process. The name is short and not derived from the target's, which may be as long as names can be. */
static int create_beside(const char *target, char *name, size_t size)
{
    const char *slash = strrchr(target, '/');
    int folder_length = slash ? (int)(slash - target) + 1 : 0;
    for (int attempt = 0; attempt < 100; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, size, "%.*s.eclat-%ld-%08lx.tmp", folder_length, target, (long)getpid(),
                 ((unsigned long)now.tv_sec * 1000000007ul + (unsigned long)now.tv_nsec) & 0xfffffffful);
        int fd = open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) return fd;
    }
    return -1;
}

static void release(ec_atomic_file *file)
{
    free(file->target);
    free(file->temporary);
    *file = (ec_atomic_file){.fd = -1};
}

ec_result ec_atomic_open(ec_atomic_file *file, const char *path, ec_error *err)
{
    *file = (ec_atomic_file){.fd = -1};
    if (!path[0]) return ec_fail(err, "cannot write an image: the output path is empty; give a file name");
    if (path[strlen(path) - 1] == '/')
        return ec_fail(err, "cannot write '%s': it names a folder; give a file name", path);
    EC_TRY(check_replaceable(path, err));

    file->target = realpath(path, NULL); /* so that a symbolic link stays one; fails when there is nothing yet */
    if (!file->target) file->target = strdup(path);
    size_t size = file->target ? strlen(file->target) + 64 : 0;
    file->temporary = size ? malloc(size) : NULL;
    if (!file->temporary) {
        release(file);
        return ec_fail(err, "cannot write '%s': out of memory", path);
    }
    file->fd = create_beside(file->target, file->temporary, size);
    if (file->fd >= 0) return EC_OK;
    int reason = errno;
    release(file);
    return ec_write_failed(err, path, reason);
}

void ec_atomic_abort(ec_atomic_file *file)
{
    if (file->fd < 0) return;
    close(file->fd);
    unlink(file->temporary);
    release(file);
}

/* The rename itself survives a power cut only once the folder is on disk too. Best effort: not every file system can. */
static void sync_folder(char *target)
{
    char *slash = strrchr(target, '/');
    if (slash) *slash = 0;
    int fd = open(!slash ? "." : slash == target ? "/" : target, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (slash) *slash = '/';
    if (fd < 0) return;
    (void)fsync(fd);
    close(fd);
}

ec_result ec_atomic_commit(ec_atomic_file *file, ec_error *err)
{
    struct stat old;
    if (stat(file->target, &old) == 0) (void)fchmod(file->fd, old.st_mode & 0777); /* as writing in place would */

    /* EINVAL: a file system without fsync. close() may report what a network file system refused late. */
    int failed = fsync(file->fd) != 0 && errno != EINVAL ? errno : 0;
    if (close(file->fd) != 0 && !failed && errno != EINTR) failed = errno;
    if (!failed && rename(file->temporary, file->target) != 0) failed = errno;
    if (failed) {
        unlink(file->temporary);
        ec_write_failed(err, file->target, failed);
    } else {
        sync_folder(file->target);
    }
    release(file);
    return failed ? EC_FAILED : EC_OK;
}

ec_result ec_image_check_writable(const char *path, ec_error *err)
{
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));
    ec_atomic_abort(&file);
    return EC_OK;
}
