/* Goes over every file of the folders given, as libFuzzer would; without libFuzzer. */
#include <dirent.h>

#include "fuzz.h"

static int compare(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static void judge(const char *path)
{
    FILE *file = fopen(path, "rb");
    PROMISE(file, "cannot open %s", path);
    uint8_t *bytes = NULL;
    size_t size = 0, got = 1;
    while (got > 0) {
        bytes = realloc(bytes, size + 65536);
        PROMISE(bytes, "out of memory");
        size += got = fread(bytes + size, 1, 65536, file);
    }
    fclose(file);
    fprintf(stderr, "%s\n", path); /* the last line names the culprit */
    bytes = realloc(bytes, size ? size : 1); /* so that a read past the end is seen */
    LLVMFuzzerTestOneInput(bytes, size);
    free(bytes);
}

int main(int argc, char **argv)
{
    int count = 0;
    for (int i = 1; i < argc; i++) {
        struct dirent **entries;
        int n = scandir(argv[i], &entries, NULL, compare);
        PROMISE(n >= 0, "cannot list %s", argv[i]);
        for (int k = 0; k < n; k++) {
            char path[4096];
            snprintf(path, sizeof path, "%s/%s", argv[i], entries[k]->d_name);
            if (entries[k]->d_name[0] != '.') judge(path), count++;
            free(entries[k]);
        }
        free(entries);
    }
    printf("%d inputs\n", count);
    return count ? 0 : 1;
}
