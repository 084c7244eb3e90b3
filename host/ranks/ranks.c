#include <stdlib.h>

#include "ranks/job.h"
#include "ranks/remote.h"

ec_result ec_ranks_join(ec_ranks **ranks, ec_error *err)
{
    ec_ranks *r = *ranks = calloc(1, sizeof *r);
    if (!r) return ec_fail(err, "out of memory");
    EC_TRY(ec_post_open(&r->post, err));
    r->rank = ec_post_rank(r->post);
    r->size = ec_post_size(r->post);
    r->last_box = EC_BOX_RESULTS;
    r->remote_count = (uint32_t)ec_post_children(r->post);
    r->remotes = calloc(r->remote_count + 1, sizeof *r->remotes);
    pthread_mutex_init(&r->lock, NULL);
    return r->remotes ? EC_OK : ec_fail(err, "out of memory for %u ranks", r->remote_count);
}

int ec_ranks_number(const ec_ranks *ranks) { return ranks->rank; }
int ec_ranks_count(const ec_ranks *ranks) { return ranks->size; }

void ec_ranks_share_devices(const ec_ranks *r, ec_device_info *devices, uint32_t *indices, uint32_t *count)
{
    const uint32_t of = (uint32_t)ec_post_local_size(r->post), first = (uint32_t)ec_post_local_rank(r->post) % *count;
    uint32_t kept = 0;
    for (uint32_t i = first; i < *count; i += of) {
        devices[kept] = devices[i];
        indices[kept++] = indices[i];
    }
    *count = kept;
}

static ec_result send_job(void *user, const ec_cargo *cargo, uint64_t seed, const ec_log *log, ec_error *err)
{
    ec_ranks *r = user;
    return ec_job_send(r, cargo, seed, r->device, log, err);
}

bool ec_ranks_recruit(void *user, uint32_t i, ec_team_recruit *recruit)
{
    ec_remote *m = &((ec_ranks *)user)->remotes[i];
    *recruit = (ec_team_recruit){.name = m->name, .open = ec_remote_open, .user = m, .processes = m->ready};
    return m->is_ready;
}

ec_allies ec_ranks_allies(ec_ranks *r, const char *device)
{
    r->device = device;
    return (ec_allies){.count = r->remote_count, .send = send_job, .recruit = ec_ranks_recruit, .user = r};
}

/* What a rank sent last may still be on its way, and MPI does not end before it is taken: so they say farewell, behind all else. */
void ec_ranks_leave(ec_ranks *r)
{
    if (!r) return;
    const ec_letter home = {.kind = EC_WORD_HOME, .box = EC_BOX_WORD};
    const int children = (int)r->remote_count;
    for (int i = 0; i < children; i++) (void)ec_post_send(r->post, ec_post_child(r->post, i), &home, NULL);
    for (int i = 0; i < children; i++) {
        ec_letter farewell = {.kind = EC_WORD_JOB};
        while (farewell.kind != EC_WORD_HOME && ec_post_receive(r->post, ec_post_child(r->post, i), EC_BOX_WORD, NULL, NULL, &farewell, NULL) == EC_OK)
            free(farewell.body);
    }
    if (r->rank > 0) (void)ec_post_send(r->post, ec_post_parent(r->post), &home, NULL);
    ec_post_close(r->post);
    free(r->remotes);
    pthread_mutex_destroy(&r->lock);
    free(r);
}
