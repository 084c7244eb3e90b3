#define _GNU_SOURCE /* for O_TMPFILE */
#include "base/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

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
    case EIO: remedy = "free some space or choose another disk"; break;
    case EFBIG: remedy = "raise the limit on the size of files (ulimit -f) or choose another disk"; break;
    }
    return ec_fail(err, "cannot write '%s': %s; %s", path, strerror(error_number), remedy);
}

/* Fails unless whatever is at `path` is a regular file that we may write: renaming over a device such as /dev/null would destroy it, and renaming
 * over a read-only file would circumvent its owner's intention. */
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

static int folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

char *ec_link_end(const char *path)
{
    enum { LINKS_MOST = 40 }; /* as in the kernel */
    char *at = strdup(path);
    for (int i = 0; at && i < LINKS_MOST; i++) {
        char to[PATH_MAX], next[2 * PATH_MAX];
        ssize_t size = readlink(at, to, sizeof to);
        if (size < 0) return at; /* not a link, or nothing there */
        int folder = to[0] == '/' ? 0 : folder_length(at);
        snprintf(next, sizeof next, "%.*s%.*s", folder, at, (int)size, to);
        free(at);
        at = strdup(next);
    }
    errno = at ? ELOOP : ENOMEM;
    free(at);
    return NULL;
}

static int link_descriptor(int fd, const char *name)
{
    char descriptor[64];
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", fd);
    return linkat(AT_FDCWD, descriptor, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

/* Makes up a name beside the target: for a new file if fd < 0, else for that one. It is short and not derived from the target's name, which may have
 * the maximal length. Uses open() rather than mkstemp(), so that the kernel applies the umask to 0666; a library cannot read the umask without
 * changing it for the whole process. */
static int take_name(int fd, const char *target, char *name, size_t size)
{
    for (int attempt = 0; attempt < 100; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, size, "%.*s.eclat-%ld-%08lx.tmp", folder_length(target), target, (long)getpid(),
                 ((unsigned long)now.tv_sec * 1000000007ul + (unsigned long)now.tv_nsec) & 0xfffffffful);
        int taken = fd < 0 ? open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : link_descriptor(fd, name);
        if (taken >= 0 || errno != EEXIST) return taken;
    }
    return -1;
}

/* Creates the file without a name, so that a killed process leaves nothing behind; with a name if the file system or the lack of /proc prevents that. */
static int create_beside(const char *target, char *name, size_t size)
{
    name[0] = 0;
#ifdef O_TMPFILE
    char folder[PATH_MAX], descriptor[64];
    snprintf(folder, sizeof folder, "%.*s.", folder_length(target), target);
    int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", fd);
    if (fd >= 0 && access(descriptor, F_OK) == 0) return fd;
    if (fd >= 0) close(fd);
#endif
    return take_name(-1, target, name, size);
}

/* Gives the file its target name. A nameless file that replaces another needs a temporary name first: only here a killed process can leave one
 * behind. */
static int give_target_name(ec_atomic_file *file)
{
    if (!file->temporary[0]) {
        if (link_descriptor(file->fd, file->target) == 0) return 0;
        if (errno != EEXIST || take_name(file->fd, file->target, file->temporary, file->temporary_size) < 0) return -1;
    }
    return rename(file->temporary, file->target);
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
    if (!path[0]) return ec_fail(err, "cannot write: the output path is empty; give a file name");
    if (path[strlen(path) - 1] == '/')
        return ec_fail(err, "cannot write '%s': it names a folder; give a file name", path);
    EC_TRY(check_replaceable(path, err));

    file->target = ec_link_end(path); /* so that a symbolic link remains one */
    size_t size = file->target ? strlen(file->target) + 64 : 0;
    file->temporary = size ? malloc(size) : NULL;
    file->temporary_size = size;
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
    if (file->temporary[0]) unlink(file->temporary);
    release(file);
}

/* Syncs the folder, without which the rename may not survive a power cut. Best effort: not every file system can. */
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
    if (stat(file->target, &old) == 0) (void)fchmod(file->fd, old.st_mode & 0777); /* like writing in place */

    /* EINVAL: a file system without fsync. Closing a copy may report what a network file system refused late. */
    int failed = fsync(file->fd) != 0 && errno != EINVAL ? errno : 0;
    int copy = dup(file->fd);
    if (copy >= 0 && close(copy) != 0 && !failed && errno != EINTR) failed = errno;
    if (!failed && give_target_name(file) != 0) failed = errno;
    close(file->fd);
    if (failed) {
        if (file->temporary[0]) unlink(file->temporary);
        ec_write_failed(err, file->target, failed);
    } else {
        sync_folder(file->target);
    }
    release(file);
    return failed ? EC_FAILED : EC_OK;
}

int ec_write_all(int fd, const void *bytes, size_t size, off_t at)
{
    for (size_t done = 0; done < size;) {
        const char *rest = (const char *)bytes + done;
        ssize_t put = at < 0 ? write(fd, rest, size - done) : pwrite(fd, rest, size - done, at + (off_t)done);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return put < 0 ? errno : ENOSPC;
        done += (size_t)put;
    }
    return 0;
}

ec_result ec_atomic_append(ec_atomic_file *file, const void *bytes, size_t size, ec_error *err)
{
    int failed = ec_write_all(file->fd, bytes, size, -1);
    if (!failed) return EC_OK;
    ec_write_failed(err, file->target, failed);
    ec_atomic_abort(file);
    return EC_FAILED;
}

ec_result ec_atomic_write(const char *path, const void *bytes, size_t size, ec_error *err)
{
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));
    EC_TRY(ec_atomic_append(&file, bytes, size, err));
    return ec_atomic_commit(&file, err);
}
