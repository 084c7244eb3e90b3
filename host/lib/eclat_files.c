/* Functions over files of pictures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/command_line.h"
#include "jobs/compare_job.h"
#include "jobs/usage.h"
#include "lib/internal.h"

eclat_result eclat_compare(const char *a, const char *b, eclat_comparison *comparison, eclat_error *err)
{
    ec_error why = {0};
    ec_compare_job job = {.a = {0}};
    ec_result result = ec_compare_load(a, b, &job, &why);
    if (result == EC_OK) result = ec_compare_measure(&job.report, NULL, &why);
    const ec_difference *d = &job.report.difference;
    *comparison = (eclat_comparison){.rmse = d->rmse, .relative_rms = d->relative_rms, .relmse = d->relmse, .mape = d->mape, .psnr = d->psnr,
                                     .p = job.report.tested ? job.report.test.p : NAN, .differ = job.report.differ};
    ec_compare_free(&job);
    return ec_lib_end(result, &why, err);
}

static ec_result write_merged(eclat_picture *picture, ec_outputs *outputs, ec_error *err)
{
    return ec_merged_write(&picture->merged, outputs, 0, EC_TONEMAP_NEUTRAL, err);
}

/* "eclat merge A.exr B.exr"; malloc'ed. */
static char *make_command(char *const *paths, int count)
{
    char **words = malloc(((size_t)count + 2) * sizeof *words), *line;
    if (!words) return NULL;
    words[0] = (char[]){"eclat"};
    words[1] = (char[]){"merge"};
    memcpy(words + 2, paths, (size_t)count * sizeof *words);
    line = ec_command_line(count + 2, words);
    free(words);
    return line;
}

static ec_result merge(char **paths, int count, bool is_partial, const ec_log *log, eclat_picture *p, ec_error *err)
{
    ec_merged *m = &p->merged;
    if (count < 1) return ec_usage(err, "there is nothing to merge: name one slice or more");
    if (!(p->command = make_command(paths, count))) return ec_fail(err, "out of memory for a command line");
    EC_TRY(ec_merged_make(paths, count, is_partial, p->command, m, log, err));
    p->attributes.count = ec_merged_attributes(m, p->attributes.list);
    p->error = m->error;
    p->samples_per_pixel = (double)m->samples_per_pixel;
    p->replicates = ec_film_replicates(&m->slices.all.film);
    p->write = write_merged;
    return ec_lib_picture_finish(p, err);
}

eclat_result eclat_merge(const char *const *paths, size_t count, int is_partial, const eclat_listener *listener, eclat_picture **picture, eclat_error *err)
{
    ec_error why = {0};
    ec_lib_ear ear = {listener, NULL};
    const ec_log log = ec_lib_listener(&ear).log;
    eclat_picture *made = calloc(1, sizeof *made);
    char **sorted = malloc((count + 1) * sizeof *sorted);
    ec_result result = made && sorted ? EC_OK : ec_fail(&why, "out of memory for a picture");
    *picture = NULL;
    if (sorted) memcpy(sorted, paths, count * sizeof *sorted);
    if (result == EC_OK) result = merge(sorted, (int)count, is_partial, &log, made, &why);
    free(sorted);
    if (result == EC_OK) *picture = made;
    else eclat_picture_free(made);
    return ec_lib_end(result, &why, err);
}
