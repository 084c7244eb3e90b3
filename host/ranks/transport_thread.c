/* The thread that owns MPI. */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "ranks/transport_internal.h"

enum { CHUNK = 64 << 20, TAG = 1 };   /* bytes of one message, since MPI counts in int */
#define IDLE_SECONDS 1e-3             /* between two checks … */
#define BUSY_SECONDS 2e-5             /* … while a message is under way */
#define ALIVE_SECONDS 5.0             /* at most, between two signs of life */
#define ALIVE_SIGNS 6                 /* number within the time after which a rank is lost */

static uint64_t chunks_of(uint64_t bytes) { return (bytes + CHUNK - 1) / CHUNK; }
static int chunk_bytes(uint64_t bytes, uint64_t i) { return bytes - i * CHUNK < CHUNK ? (int)(bytes - i * CHUNK) : CHUNK; }

static bool is_peer(const ec_transport *p, int rank)
{
    const ec_rank_place *place = &p->place;
    return rank == place->parent || (rank >= place->first_child && rank < place->first_child + place->children);
}

/* Returns the value of an environment variable, if it is above 0. */
static double setting(const char *name, double otherwise)
{
    const char *given = getenv(name);
    const double value = given ? atof(given) : 0;
    return value > 0 ? value : otherwise;
}

/* Called with the lock held. */
static void lose(ec_transport *p, int rank)
{
    p->peers[rank].lost = true;
    pthread_cond_broadcast(&p->peers[rank].news);
}

static void begin_sending(ec_transport *p, outgoing *o)
{
    uint64_t chunks = chunks_of(o->head.bytes);
    o->begun = true;
    o->requests = malloc((chunks + 1) * sizeof *o->requests);
    o->failed = !o->requests || p->peers[o->to].lost;
    if (!o->failed)
        o->failed = MPI_Isend(&o->head, (int)sizeof o->head, MPI_BYTE, o->to, TAG, p->comm,
                              &o->requests[o->request_count++]) != MPI_SUCCESS;
    for (uint64_t i = 0; i < chunks && !o->failed; i++)
        o->failed = MPI_Isend((char *)o->body + i * CHUNK, chunk_bytes(o->head.bytes, i), MPI_BYTE, o->to, TAG, p->comm,
                              &o->requests[o->request_count++]) != MPI_SUCCESS;
}

/* Returns true when it has ended, successfully or not. */
static bool test_sending(ec_transport *p, outgoing *o)
{
    int all = 0;
    if (!o->begun) begin_sending(p, o);
    if (!o->failed)
        o->failed = MPI_Testall(o->request_count, o->requests, &all, MPI_STATUSES_IGNORE) != MPI_SUCCESS ||
                    (!all && p->peers[o->to].lost);
    if (o->failed) lose(p, o->to);
    return all || o->failed;
}

/* Returns whether something is still being sent. Called with the lock held. */
static bool send_messages(ec_transport *p)
{
    bool busy = false;
    for (outgoing **at = &p->to_send; *at;) {
        outgoing *o = *at;
        if (!test_sending(p, o)) {
            busy = true;
            at = &o->next;
            continue;
        }
        *at = o->next;
        free(o->requests);
        pthread_cond_broadcast(&p->peers[o->to].news);
        if (o->own) free(o->body), free(o);
        else o->done = true;
    }
    return busy;
}

static void deliver(peer *from)
{
    incoming *whole = from->open;
    from->open = NULL;
    if (whole->message.kind == EC_MESSAGE_ALIVE) {
        free(whole);
        return;
    }
    if (from->last) from->last->next = whole;
    else from->first = whole;
    from->last = whole;
    pthread_cond_broadcast(&from->news);
}

static bool take_head(peer *from)
{
    const head *h = &from->head;
    incoming *in = calloc(1, sizeof *in);
    if (!in) return false;
    in->message = (ec_message){.kind = h->kind, .box = h->box, .bytes = h->bytes, .body = h->bytes ? malloc(h->bytes) : NULL};
    memcpy(in->message.numbers, h->numbers, sizeof h->numbers);
    from->open = in;
    from->filled = 0;
    if (h->bytes == 0) deliver(from);
    return !h->bytes || in->message.body;
}

static void take_chunk(peer *from)
{
    const ec_message *message = &from->open->message;
    from->filled += (uint64_t)chunk_bytes(message->bytes, from->filled / CHUNK);
    if (from->filled == message->bytes) deliver(from);
}

/* Advances one message of a peer by one step; *moved: there was one. Returns false if the peer is lost. */
static bool receive_from(ec_transport *p, int rank, bool *moved)
{
    peer *from = &p->peers[rank];
    MPI_Message probed;
    int there = 0, whole = 0;
    const ec_message *message = from->open ? &from->open->message : NULL;
    if (!from->receiving) {
        if (MPI_Improbe(rank, TAG, p->comm, &there, &probed, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
        if (!there) return true;
        void *to = message ? (char *)message->body + from->filled : (void *)&from->head;
        int count = message ? chunk_bytes(message->bytes, from->filled / CHUNK) : (int)sizeof from->head;
        if (MPI_Imrecv(to, count, MPI_BYTE, &probed, &from->request) != MPI_SUCCESS) return false;
        from->receiving = true;
    }
    *moved = true;
    if (MPI_Test(&from->request, &whole, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
    if (!whole) return true;
    from->receiving = false;
    from->heard = ec_now();
    p->received += message ? (uint64_t)chunk_bytes(message->bytes, from->filled / CHUNK) : sizeof from->head;
    if (!message) return take_head(from);
    take_chunk(from);
    return true;
}

/* Tells whether the process of a rank on this host has ended; there is no need to wait for it. */
static bool has_ended(const peer *from) { return from->process && kill(from->process, 0) != 0 && errno == ESRCH; }

/* Returns whether anything was received. Called with the lock held. */
static bool receive_messages(ec_transport *p)
{
    bool any = false;
    for (int r = 0; r < p->place.size; r++) {
        if (!is_peer(p, r) || p->peers[r].lost) continue;
        bool moved = false;
        const bool is_over = has_ended(&p->peers[r]); /* checked first, so that its last messages are still received */
        if (!receive_from(p, r, &moved) || (is_over && !moved) || ec_now() - p->peers[r].heard > p->lost_after) lose(p, r);
        any |= moved;
    }
    return any;
}

static void say_alive(ec_transport *p)
{
    if (ec_now() - p->said_alive < fmin(ALIVE_SECONDS, p->lost_after / ALIVE_SIGNS)) return;
    p->said_alive = ec_now();
    for (int r = 0; r < p->place.size; r++) {
        if (!is_peer(p, r) || p->peers[r].lost) continue;
        outgoing *o = calloc(1, sizeof *o);
        if (!o) return;
        *o = (outgoing){.to = r, .head.kind = EC_MESSAGE_ALIVE, .own = true, .next = p->to_send};
        p->to_send = o;
    }
}

/* Finds the processes of the ranks on this host, if all of them number processes alike, in one namespace. */
static void find_processes(ec_transport *p, MPI_Comm local)
{
    struct stat space = {0};
    (void)stat("/proc/self/ns/pid", &space);
    const uint64_t own[3] = {(uint64_t)p->place.rank, (uint64_t)getpid(), space.st_ino};
    uint64_t(*all)[3] = malloc((size_t)p->place.local_size * sizeof own);
    if (!all || MPI_Allgather(own, sizeof own, MPI_BYTE, all, sizeof own, MPI_BYTE, local) != MPI_SUCCESS) p->open = false;
    for (int i = 0; p->open && i < p->place.local_size; i++)
        if (space.st_ino && all[i][2] == own[2]) p->peers[all[i][0]].process = (pid_t)all[i][1];
    free(all);
}

static void start(ec_transport *p)
{
    int provided = MPI_THREAD_SINGLE;
    ec_rank_place *place = &p->place;
    MPI_Comm local;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS || provided < MPI_THREAD_FUNNELED) {
        ec_fail(&p->error, "this MPI does not support programs with threads (MPI_THREAD_FUNNELED); use another MPI");
        return;
    }
    MPI_Comm_dup(MPI_COMM_WORLD, &p->comm);
    MPI_Comm_set_errhandler(p->comm, MPI_ERRORS_RETURN);
    MPI_Comm_rank(p->comm, &place->rank);
    MPI_Comm_size(p->comm, &place->size);
    p->lost_after = setting("ECLAT_RANK_LOST", EC_LOST_SECONDS);
    const int64_t fanout = (int64_t)fmax(setting("ECLAT_RANK_FANOUT", EC_TREE_FANOUT), 1), first = place->rank * fanout + 1, left = place->size - first;
    place->parent = place->rank ? (int)((place->rank - 1) / fanout) : -1;
    place->first_child = (int)(left > 0 ? first : place->size);
    place->children = (int)(left < 0 ? 0 : left < fanout ? left : fanout);
    MPI_Comm_split_type(p->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
    MPI_Comm_rank(local, &place->local_rank);
    MPI_Comm_size(local, &place->local_size);
    p->peers = calloc((size_t)place->size, sizeof *p->peers);
    p->open = p->peers != NULL;
    if (p->open) find_processes(p, local);
    MPI_Comm_free(&local);
    if (!p->open) ec_fail(&p->error, "out of memory");
    for (int r = 0; p->open && r < place->size; r++) p->peers[r].heard = ec_now(), pthread_cond_init(&p->peers[r].news, NULL);
}

void *ec_transport_run(void *user)
{
    ec_transport *p = user;
    pthread_mutex_lock(&p->lock);
    start(p);
    pthread_cond_broadcast(&p->news);
    while (p->open && (!p->closing || p->to_send)) {
        say_alive(p);
        bool busy = send_messages(p);
        busy |= receive_messages(p);
        ec_transport_wait(p, &p->call, busy ? BUSY_SECONDS : IDLE_SECONDS);
    }
    pthread_mutex_unlock(&p->lock);
    int is_there = 0;
    if (MPI_Initialized(&is_there) == MPI_SUCCESS && is_there) MPI_Finalize();
    pthread_mutex_lock(&p->lock);
    p->closed = true;
    pthread_cond_broadcast(&p->news);
    pthread_mutex_unlock(&p->lock);
    return NULL;
}
