#include <math.h>

#include "jobs/compare_job.h"
#include "lib/internal.h"

eclat_result eclat_compare(const char *a, const char *b, eclat_comparison *comparison, eclat_error *err)
{
    ec_error why = {0};
    ec_compare_job job = {.a = {0}};
    ec_result result = ec_compare_load(a, b, &job, &why);
    if (result == EC_OK) result = ec_compare_measure(&job, &(ec_compare_options){.mask = NULL}, &why);
    const ec_difference *d = &job.report.difference;
    *comparison = (eclat_comparison){.rmse = d->rmse, .relative_rms = d->relative_rms, .relmse = d->relmse, .mape = d->mape, .psnr = d->psnr,
                                     .p = job.report.tested ? job.report.test.p : NAN, .differ = job.report.differ};
    ec_compare_free(&job);
    return ec_lib_end(result, &why, err);
}
