#include "lib/internal.h"
#include "ranks/ranks.h"

eclat_result eclat_ranks_join(eclat_ranks **ranks, eclat_error *err)
{
    ec_error why = {0};
    ec_ranks *joined = NULL;
    const ec_result result = ec_ranks_launched() < 2 ? EC_OK : ec_ranks_join(&joined, &why);
    *ranks = (eclat_ranks *)joined;
    return ec_lib_end(result, &why, err);
}

int eclat_ranks_number(const eclat_ranks *ranks)
{
    return ranks ? ec_ranks_number((const ec_ranks *)ranks) : !ec_ranks_launched_first();
}

/* A rank that fails does not leave, so that the launcher ends the others, which may be waiting for it. */
eclat_result eclat_ranks_serve(eclat_ranks *ranks, const eclat_listener *listener, eclat_error *err)
{
    ec_error why = {0};
    ec_ranks *r = (ec_ranks *)ranks;
    ec_lib_ear ear = {.listener = listener};
    const ec_log log = ec_lib_listener(&ear).log;
    const ec_result result = ec_ranks_serve(r, &log, &why);
    if (result == EC_OK) ec_ranks_leave(r);
    else ec_fail_more(&why, "; this was rank %d; eclat render --resume FILE continues from what --checkpoint FILE saved", ec_ranks_number(r));
    return ec_lib_end(result, &why, err);
}

void eclat_ranks_leave(eclat_ranks *ranks) { ec_ranks_leave((ec_ranks *)ranks); }
