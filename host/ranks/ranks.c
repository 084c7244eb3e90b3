#include <stdlib.h>
#include <string.h>

#include <mpi.h>

#include "base/module.h"
#include "ranks/ranks_internal.h"

/* Fails if the launcher belongs to another MPI, with which each process would be rank 0 of one. */
static ec_result fail_of_launcher(int size, ec_error *err)
{
    char library[MPI_MAX_LIBRARY_VERSION_STRING];
    int length;
    MPI_Get_library_version(library, &length);
    library[strcspn(library, ",\n")] = 0;
    return ec_fail(err, "%d processes were started, but each finds %d: the launcher belongs to another MPI than this eclat (%s); use the mpirun of "
                        "that MPI, or build eclat with the launcher's (cmake -DMPI_C_COMPILER=MPICC)", ec_ranks_launched(), size, library);
}

static ec_result join(ec_ranks **ranks, ec_error *err)
{
    ec_ranks *r = *ranks = calloc(1, sizeof *r);
    if (!r) return ec_fail(err, "out of memory");
    pthread_mutex_init(&r->lock, NULL);
    EC_TRY(ec_transport_open(&r->transport, err));
    r->place = ec_transport_place(r->transport);
    r->head.number = r->place->rank;
    r->head.count = r->place->size;
    r->last_box = EC_BOX_RESULTS;
    r->remote_count = (uint32_t)r->place->children;
    if (r->place->size != ec_ranks_launched()) return fail_of_launcher(r->place->size, err);
    r->remotes = calloc(r->remote_count + 1, sizeof *r->remotes);
    return r->remotes ? EC_OK : ec_fail(err, "out of memory for %u ranks", r->remote_count);
}

static ec_result send_job(void *user, const ec_payload *payload, uint64_t seed, const ec_log *log, ec_error *err)
{
    ec_ranks *r = user;
    return ec_job_send(r, payload, seed, log, err);
}

static uint64_t received(void *user) { return ec_transport_received(((const ec_ranks *)user)->transport); }

static ec_peers peers(ec_ranks *r, const char *device, const char *own, bool own_round)
{
    r->device = device;
    r->own = own;
    r->own_round = own_round;
    return (ec_peers){.count = r->remote_count, .send = send_job, .candidate = ec_ranks_candidate, .received = received, .user = r};
}

/* Waits for the next word of that rank that ends something: the parent's order, or a child's answer. Returns whether anybody was lost. */
static bool hear_end(ec_ranks *r, int from, uint32_t kind)
{
    ec_message message;
    do {
        if (ec_transport_receive(r->transport, from, EC_BOX_WORD, NULL, NULL, &message, NULL) != EC_OK) return true;
        free(message.body);
    } while (message.kind != kind);
    return message.numbers[EC_END_LOST];
}

static bool say_end(ec_ranks *r, int to, uint32_t kind, bool lost)
{
    const ec_message message = {.kind = kind, .box = EC_BOX_WORD, .numbers = {[EC_END_LOST] = lost}};
    return ec_transport_send(r->transport, to, &message, NULL) != EC_OK;
}

/* Leaves MPI, which does not end before the last messages of all ranks are received: so ranks exchange farewells after everything else. MPI does not
 * end at all if a rank is lost, which only some ranks know: so farewells say that, and the root tells all. */
static void leave(ec_ranks *r)
{
    if (!r) return;
    const int first = r->place ? r->place->first_child : 0, end = first + (int)r->remote_count, parent = r->place ? r->place->parent : -1;
    bool lost = false;
    for (int child = first; child < end; child++) lost |= say_end(r, child, EC_WORD_HOME, false);
    for (int child = first; child < end; child++) lost |= hear_end(r, child, EC_WORD_HOME);
    if (parent >= 0) lost |= say_end(r, parent, EC_WORD_HOME, lost) || hear_end(r, parent, EC_WORD_OVER);
    for (int child = first; child < end; child++) lost |= say_end(r, child, EC_WORD_OVER, lost);
    ec_transport_close(r->transport, lost);
    free(r->remotes);
    pthread_mutex_destroy(&r->lock);
    free(r);
}

EC_MODULE_EXPORT extern const ec_ranks_module EC_MODULE_SYMBOL;
const ec_ranks_module EC_MODULE_SYMBOL = {join, peers, ec_mpi_share_devices, ec_mpi_note_binding, leave, ec_mpi_serve};
