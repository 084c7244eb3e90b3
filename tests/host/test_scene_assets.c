/* tier: full */
/* Every .gltf and .glb under the shared assets, good and bad, each in its own process with a time limit: no crash, no hang, finite data.
 * Good files load, and so do files in which Khronos' validator finds no error. */
#define _XOPEN_SOURCE 700
#include <ftw.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gltf/reader.h"
#include "scene/validate.h"
#include "support/test.h"

enum { LOADED = 0, REFUSED = 3, LIMIT_SECONDS = 20, MAX_FILES = 4000 };

static char *files[MAX_FILES];
static int file_count;

static int collect(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info, (void)where;
    const char *dot = strrchr(path, '.');
    if (type == FTW_F && dot && (!strcmp(dot, ".gltf") || !strcmp(dot, ".glb")) && file_count < MAX_FILES)
        files[file_count++] = strdup(path);
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void run_child(const char *path, int out)
{
    ec_error err = {0};
    ec_scene *scene;
    alarm(LIMIT_SECONDS);
    if (ec_scene_load(path, &scene, NULL, &err) != EC_OK) {
        if (!err.text[0] || strchr(err.text, '\n') || strncmp(err.text, path, strlen(path)) != 0)
            snprintf(err.text, sizeof err.text, "BAD MESSAGE");
        if (write(out, err.text, strlen(err.text) + 1) < 0) exit(1);
        exit(REFUSED);
    }
    int result = ec_scene_validate(scene, &err) == EC_OK ? LOADED : 1;
    ec_scene_free(scene);
    exit(result); /* not _exit: leaks count as well */
}

/* LOADED, REFUSED with the message, or -1 for anything else. */
static int load_in_child(const char *path, char message[2048])
{
    int pipe_ends[2], status;
    message[0] = 0;
    if (pipe(pipe_ends)) return -1;
    pid_t child = fork();
    if (!child) run_child(path, pipe_ends[1]);
    close(pipe_ends[1]);
    ssize_t got = read(pipe_ends[0], message, 2047);
    message[got > 0 ? got : 0] = 0;
    close(pipe_ends[0]);
    waitpid(child, &status, 0);
    if (!WIFEXITED(status)) return -1;
    int code = WEXITSTATUS(status);
    return code == LOADED || code == REFUSED ? code : -1;
}

/* Reasons of eclat's, not the file's. */
static int is_known_limit(const char *message)
{
    return strstr(message, "which eclat does not support") || strstr(message, "nothing to render") ||
           strstr(message, "eclat reads glTF 2.0") || strstr(message, "refusing URI \"http://");
}

/* numErrors of the validator's report beside the file; -1 = no report. */
static int reported_errors(const char *path)
{
    char name[4096], text[2048];
    snprintf(name, sizeof name, "%s.report.json", path);
    FILE *file = fopen(name, "rb");
    if (!file) return -1;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    const char *found = strstr(text, "\"numErrors\":");
    return found ? atoi(found + 12) : -1;
}

typedef struct tally {
    int files, loaded, limited, refused, clean, clean_loaded, faulty, faulty_refused;
} tally;

static void sweep(const char *folder, int must_load, tally *t)
{
    char root[1024], message[2048];
    snprintf(root, sizeof root, "%s/%s", ECLAT_SHARED, folder);
    file_count = 0;
    nftw(root, collect, 16, FTW_PHYS);
    qsort(files, (size_t)file_count, sizeof *files, by_name);
    for (int i = 0; i < file_count; i++) {
        int result = load_in_child(files[i], message), errors = reported_errors(files[i]);
        int limited = result == REFUSED && is_known_limit(message);
        CHECK_MSG(result >= 0, "%s crashes, hangs or gives bad data", files[i]);
        CHECK_MSG(strcmp(message, "BAD MESSAGE") != 0, "%s: no clear message", files[i]);
        if (must_load || errors == 0) CHECK_MSG(result == LOADED || limited, "%s", message);
        if (result == REFUSED && getenv("ECLAT_TEST_VERBOSE")) printf("%s\n", message);
        if (result == LOADED && errors > 0 && getenv("ECLAT_TEST_VERBOSE")) printf("%s: loads with errors\n", files[i]);
        t->files++;
        t->loaded += result == LOADED;
        t->limited += limited;
        t->refused += result == REFUSED && !limited;
        t->clean += errors == 0;
        t->clean_loaded += errors == 0 && (result == LOADED || limited);
        t->faulty += errors > 0;
        t->faulty_refused += errors > 0 && result == REFUSED;
        free(files[i]);
    }
    printf("%s: %d files, %d loaded, %d with nothing to render or an unsupported extension, %d refused\n", folder,
           t->files, t->loaded, t->limited, t->refused);
}

int main(void)
{
    tally good = {0}, classic = {0}, hard = {0}, bad = {0};
    setvbuf(stdout, NULL, _IOLBF, 0);
    sweep("assets/gltf", 1, &good);
    sweep("assets/classic/gltf", 1, &classic);
    sweep("assets/hard", 1, &hard);
    sweep("assets/bad-gltf", 0, &bad);
    if (!(good.files + classic.files + hard.files + bad.files)) TEST_SKIP("no assets under %s", ECLAT_SHARED);
    printf("Khronos' validator: of %d files without errors %d load (or hold nothing to render); of %d with errors %d are "
           "refused, the rest loads with finite data\n", bad.clean, bad.clean_loaded, bad.faulty, bad.faulty_refused);
    ec_error err;
    ec_scene *scene;
    const char *million = ECLAT_SHARED "/assets/gltf/MetalRoughSpheresNoTextures/glTF/MetalRoughSpheresNoTextures.gltf";
    if (access(million, R_OK) == 0) {
        CHECK_OK(ec_scene_load(million, &scene, NULL, &err), err);
        if (scene) CHECK(scene->triangle_count + scene->dropped_degenerate == 1040409 && !scene->dropped_nonfinite);
        ec_scene_free(scene);
    }
    TEST_END();
}
