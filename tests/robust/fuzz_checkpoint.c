/* Fuzzes checkpoints and slices. The input has no seal: the fuzzer adds one that fits, so that the reader gets as far as the contents. An
 * input that begins with a brace is the JSON object alone, which mutants of whole files seldom reach. */
#include <fcntl.h>
#include <math.h>

#include "fuzz.h"
#include "image/seal.h"
#include "store/layout.h"
#include "store/merge.h"

enum { PIXELS_MOST = 1 << 12 }; /* larger pictures find nothing more and are slower */

static void judge_job(const ec_stored *s)
{
    PROMISE(s->job.argc >= 1 && s->job.argv[s->job.argc] == NULL, "%d arguments", s->job.argc);
    for (int i = 0; i < s->job.argc; i++) PROMISE(s->job.argv[i], "argument %d of %d", i, s->job.argc);
    PROMISE(s->job.folder && s->job.device, "no folder or device");
    PROMISE(s->job.identity.count <= EC_TRAITS_MAX, "%u traits", s->job.identity.count);
}

static void read_state(const uint8_t *data, size_t size)
{
    ec_stored stored = {0};
    ec_state_film film = {0};
    ec_error err = {0};
    char *text = malloc(size + 1);
    PROMISE(text, "out of memory");
    memcpy(text, data, size);
    text[size] = 0;
    ec_result result = ec_state_read(text, "input", &stored, &film, &err);
    fuzz_judge_result(result, &err);
    if (result == EC_OK) {
        judge_job(&stored);
        for (uint32_t i = 0; i < film.part_count; i++)
            PROMISE(ec_film_part_is_sound(film.parts[i].first, film.parts[i].count), "batches %u and %u more", film.parts[i].first, film.parts[i].count);
    }
    free(film.parts);
    ec_stored_free(&stored);
    free(text);
}

/* Checks that no two parts share a batch, and that the data of the picture's errors exist. */
static void judge_film(const ec_film *film)
{
    uint64_t end = 0, batches = 0;
    PROMISE(film->replicates >= 1 && film->replicates <= EC_REPLICATES_MOST, "%u replicates", film->replicates);
    for (uint32_t i = 0; i < film->part_count; i++) {
        PROMISE(film->parts[i].first >= end, "part %u begins with batch %u, not after %llu", i, film->parts[i].first, (unsigned long long)end);
        end = (uint64_t)film->parts[i].first + film->parts[i].count;
        batches += film->parts[i].count;
    }
    PROMISE(!film->counts || film->part_count == 1, "%u parts of an adaptive render", film->part_count);
    PROMISE(!film->cut || film->cut < ec_schedule_batch(film->replicates, ec_film_end(film) - 1).samples, "%u samples short", film->cut);
    PROMISE(batches == film->batch_count, "parts of %llu batches, not %u", (unsigned long long)batches, film->batch_count);
    ec_film_error error = ec_film_estimate_error(film); /* with any bits: the sanitizers check the arithmetic */
    PROMISE(!isnan(error.error), "an error that is no number");
}

/* Merging a file with itself must fail, since every batch would be there twice. */
static void merge_twice(const char *path)
{
    ec_merge merge = {0};
    ec_error err = {0};
    char missing[4096];
    ec_result result = ec_merge_take(&merge, path, NULL, &err);
    fuzz_judge_result(result, &err);
    if (result == EC_OK) {
        (void)ec_merge_missing(&merge, missing, sizeof missing);
        PROMISE(ec_merge_take(&merge, path, NULL, &err) != EC_OK && err.text[0], "merged with itself");
    }
    ec_merge_free(&merge);
}

static void read_file(const uint8_t *data, size_t size)
{
    ec_stored stored;
    ec_error err = {0};
    const char *path = fuzz_file(data, size);
    int fd = open(path, O_RDWR | O_CLOEXEC);
    PROMISE(fd >= 0 && ec_seal(fd) == 0, "cannot seal");
    close(fd);
    ec_result result = ec_store_read(path, &stored, &err);
    fuzz_judge_result(result, &err);
    if (result != EC_OK) return;
    judge_job(&stored);
    if ((uint64_t)stored.film.width * stored.film.height <= PIXELS_MOST) {
        judge_film(&stored.film);
        merge_twice(path);
    }
    ec_stored_free(&stored);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size && data[0] == '{') read_state(data, size);
    else read_file(data, size);
    return 0;
}
