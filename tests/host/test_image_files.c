/* tier: quick */
/* No incomplete picture: where writing fails, the folder has no new file, and old files are unchanged. */
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/image.h"
#include "support/test.h"

static const char *const folder = ECLAT_TEST_OUT "/files";
static ec_error err;

/* The three functions that write a target, with one signature. */
typedef enum { CHECK_ONLY, EXR, PNG, KINDS } kind;
static ec_result write_kind(kind k, const char *path)
{
    static float noise[256 * 256];
    for (uint32_t i = 0, seed = 1; i < 256 * 256; i++) noise[i] = (float)((seed = seed * 1664525u + 1013904223u) >> 8);
    const ec_channel channel = {"R", noise, 1};
    err.text[0] = 0;
    if (k == EXR) return ec_exr_write(path, 256, 256, &channel, 1, NULL, 0, &err);
    if (k == PNG) return ec_png_write(path, 256, 80, (const uint8_t *)noise, &err);
    return ec_image_check_writable(path, &err);
}

static const char *in_folder(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int entries(void)
{
    DIR *directory = opendir(folder);
    int count = -2; /* . and .. */
    while (readdir(directory)) count++;
    closedir(directory);
    return count;
}

static void put(const char *name, const char *content, mode_t mode)
{
    FILE *file = fopen(in_folder(name), "wb");
    fputs(content, file);
    fclose(file);
    chmod(in_folder(name), mode);
}

static int holds(const char *name, const char *content)
{
    char read[64] = {0};
    FILE *file = fopen(in_folder(name), "rb");
    if (!file) return 0;
    size_t count = fread(read, 1, sizeof read - 1, file);
    fclose(file);
    return count == strlen(content) && memcmp(read, content, count) == 0;
}

#define CHECK_REFUSED(k, path, words)                                                                                  \
    do {                                                                                                               \
        int before = entries();                                                                                        \
        CHECK(write_kind(k, path) == EC_FAILED);                                                                       \
        CHECK_MSG(strstr(err.text, words) && strstr(err.text, path) && !strchr(err.text, '\n'), "%s", err.text);       \
        CHECK(entries() == before);                                                                                    \
    } while (0)

static void impossible_targets_are_refused(kind k)
{
    char longest[300];
    memset(longest, 'x', sizeof longest);
    longest[sizeof longest - 1] = 0;
    mkdir(in_folder("sub"), 0777);
    CHECK_REFUSED(k, in_folder("no-such/out"), "create its folder");
    CHECK_REFUSED(k, in_folder("sub"), "is a folder");
    CHECK_REFUSED(k, in_folder("sub/"), "names a folder");
    CHECK_REFUSED(k, in_folder(longest), "too long");
    /* A stand-in for /dev/null, which a rename by root would replace. Never the real one: this test must be able to fail. */
    struct stat info;
    CHECK(mkfifo(in_folder("pipe"), 0666) == 0);
    CHECK_REFUSED(k, in_folder("pipe"), "not a regular file");
    CHECK(stat(in_folder("pipe"), &info) == 0 && S_ISFIFO(info.st_mode));
    unlink(in_folder("pipe"));
    put("file", "old", 0644);
    CHECK_REFUSED(k, in_folder("file/out"), "create its folder");
    CHECK(holds("file", "old"));
    CHECK(write_kind(k, "") == EC_FAILED && strstr(err.text, "empty"));
    rmdir(in_folder("sub"));
    unlink(in_folder("file"));
}

/* Root may write anywhere: if it is root, the test changes to an unprivileged user. */
static void permissions_are_respected(kind k)
{
    int root = geteuid() == 0;
    mkdir(in_folder("locked"), 0777);
    put("locked/old", "old", 0644);
    put("read-only", "old", 0444);
    chmod(in_folder("locked"), 0555);
    if (root && (chown(folder, 65534, 65534) != 0 || chown(in_folder("read-only"), 65534, 65534) != 0 ||
                 seteuid(65534) != 0))
        return;
    if (access(folder, W_OK) == 0 || !root) {
        CHECK_REFUSED(k, in_folder("locked/new"), "Permission denied");
        CHECK_REFUSED(k, in_folder("locked/old"), "Permission denied");
        CHECK_REFUSED(k, in_folder("read-only"), "Permission denied");
        CHECK(holds("locked/old", "old") && holds("read-only", "old"));
    }
    if (root) CHECK(seteuid(0) == 0);
    chmod(in_folder("locked"), 0755);
    unlink(in_folder("locked/old"));
    rmdir(in_folder("locked"));
    unlink(in_folder("read-only"));
}

/* A full disk, simulated by a limit on the file's size. */
static void a_full_disk_leaves_the_old_file(kind k)
{
    put("target", "old", 0644);
    struct rlimit usual, small;
    getrlimit(RLIMIT_FSIZE, &usual);
    small = usual;
    signal(SIGXFSZ, SIG_IGN);
    for (small.rlim_cur = 10; small.rlim_cur <= 1000; small.rlim_cur *= 100) { /* within the header, and behind it */
        setrlimit(RLIMIT_FSIZE, &small);
        CHECK_REFUSED(k, in_folder("target"), "ulimit -f");
        CHECK_REFUSED(k, in_folder("new"), "ulimit -f");
    }
    setrlimit(RLIMIT_FSIZE, &usual);
    CHECK(holds("target", "old") && access(in_folder("new"), F_OK) != 0);
    unlink(in_folder("target"));
}

static mode_t mode_of(const char *name)
{
    struct stat info;
    return stat(in_folder(name), &info) == 0 ? info.st_mode & 07777 : 0;
}

static void files_get_the_usual_mode(kind k)
{
    mode_t usual = umask(027);
    CHECK_OK(write_kind(k, in_folder("new")), err);
    CHECK_MSG(mode_of("new") == 0640, "mode %o", mode_of("new"));
    put("old", "old", 0604); /* keeps the mode of an older file */
    CHECK_OK(write_kind(k, in_folder("old")), err);
    CHECK_MSG(mode_of("old") == 0604 && !holds("old", "old"), "mode %o", mode_of("old"));
    put("behind", "old", 0644);
    CHECK(symlink("behind", in_folder("link")) == 0); /* a link stays a link; its target is replaced */
    CHECK_OK(write_kind(k, in_folder("link")), err);
    struct stat info;
    CHECK(lstat(in_folder("link"), &info) == 0 && S_ISLNK(info.st_mode) && !holds("behind", "old"));
    CHECK(entries() == 4);
    umask(usual);
    const char *const names[] = {"new", "old", "behind", "link"};
    for (int i = 0; i < 4; i++) unlink(in_folder(names[i]));
}

/* Links to a file that does not exist, by another link, and in a circle. */
static void links_that_lead_nowhere(kind k)
{
    struct stat info;
    mkdir(in_folder("sub"), 0777);
    CHECK(symlink("sub/step", in_folder("way")) == 0 && symlink("../end", in_folder("sub/step")) == 0);
    CHECK(symlink("none/end", in_folder("astray")) == 0 && symlink("circle", in_folder("circle")) == 0);
    CHECK_OK(write_kind(k, in_folder("way")), err);
    CHECK((access(in_folder("end"), F_OK) == 0) == (k != CHECK_ONLY));
    CHECK(lstat(in_folder("way"), &info) == 0 && S_ISLNK(info.st_mode));
    CHECK(lstat(in_folder("sub/step"), &info) == 0 && S_ISLNK(info.st_mode));
    CHECK_REFUSED(k, in_folder("astray"), "create its folder");
    CHECK_REFUSED(k, in_folder("circle"), "symbolic links");
    const char *const names[] = {"way", "sub/step", "end", "astray", "circle"};
    for (int i = 0; i < 5; i++) unlink(in_folder(names[i]));
    rmdir(in_folder("sub"));
}

static void checking_leaves_nothing(void)
{
    put("old", "old", 0600);
    CHECK_OK(write_kind(CHECK_ONLY, in_folder("new")), err);
    CHECK_OK(write_kind(CHECK_ONLY, in_folder("old")), err);
    CHECK(entries() == 1 && holds("old", "old") && mode_of("old") == 0600);
    unlink(in_folder("old"));
    CHECK(chdir(folder) == 0 && write_kind(CHECK_ONLY, "new") == EC_OK); /* a name without a folder */
    CHECK(write_kind(PNG, "new") == EC_OK && entries() == 1 && unlink("new") == 0);
}

int main(void)
{
    mkdir(folder, 0777);
    if (entries() != 0) TEST_SKIP("%s is not empty", folder);
    for (kind k = CHECK_ONLY; k < KINDS; k++) {
        impossible_targets_are_refused(k);
        permissions_are_respected(k);
        if (k != CHECK_ONLY) a_full_disk_leaves_the_old_file(k);
        if (k != CHECK_ONLY) files_get_the_usual_mode(k);
        links_that_lead_nowhere(k);
    }
    checking_leaves_nothing();
    CHECK(entries() == 0);
    rmdir(folder);
    TEST_END();
}
