/* Shared by the fuzzers. Each fuzz_NAME.c defines libFuzzer's entry point, which tests one input: it must be read, or refused in one line,
 * and the result must keep its promises. The sanitizers check the rest. Linked with libFuzzer by clang (-DECLAT_FUZZ=ON), or with
 * fuzz_corpus.c, which runs over stored inputs as a test. */
#ifndef EC_TESTS_ROBUST_FUZZ_H
#define EC_TESTS_ROBUST_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A broken promise ends the process, as libFuzzer expects of a finding. */
#define PROMISE(condition, ...)                                                                    \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: %s: ", __FILE__, __LINE__, #condition);                        \
            fprintf(stderr, __VA_ARGS__);                                                          \
            fputc('\n', stderr);                                                                   \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

/* A refusal is one line; success leaves none. */
static inline void fuzz_judge_result(ec_result result, const ec_error *err)
{
    PROMISE((result == EC_OK) == (err->text[0] == 0), "result %d with the message \"%s\"", (int)result, err->text);
    PROMISE(!strchr(err->text, '\n'), "more than a line: %s", err->text);
}

/* Writes the bytes to a file, always the same, that has no name on the disk and so cannot outlive a crash. Readers open files by name. */
static inline const char *fuzz_file(const uint8_t *data, size_t size)
{
    static char path[64];
    static int file = -1;
    if (file < 0) {
        char name[] = "/tmp/eclat-fuzz-XXXXXX";
        file = mkstemp(name);
        PROMISE(file >= 0 && unlink(name) == 0, "cannot write to /tmp");
        snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    }
    PROMISE(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == (ssize_t)size, "cannot write to /tmp");
    return path;
}

#endif
