/* Functions for those who send and receive messages. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "ranks/transport_internal.h"

#define ASKED_SECONDS 0.05            /* between two calls of go_on */
#define FINALIZE_SECONDS 10.0             /* for ranks to end after others are lost */

const ec_rank_place *ec_transport_place(const ec_transport *transport) { return &transport->place; }

ec_result ec_transport_open(ec_transport **transport, ec_error *err)
{
    ec_transport *p = *transport = calloc(1, sizeof *p);
    if (!p) return ec_fail(err, "out of memory");
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->call, NULL);
    pthread_cond_init(&p->news, NULL);
    if (pthread_create(&p->thread, NULL, ec_transport_run, p) != 0) {
        free(p);
        *transport = NULL; /* no thread was started that could close it */
        return ec_fail(err, "cannot start a thread for MPI");
    }
    pthread_mutex_lock(&p->lock);
    while (!p->open && !*p->error.text) pthread_cond_wait(&p->news, &p->lock);
    pthread_mutex_unlock(&p->lock);
    return p->open ? EC_OK : ec_fail(err, "%s", p->error.text);
}

void ec_transport_close(ec_transport *p, bool is_any_lost)
{
    if (!p) return;
    pthread_mutex_lock(&p->lock);
    p->closing = true;
    pthread_cond_signal(&p->call);
    const bool may_hang = p->open && is_any_lost;
    const struct timespec until = ec_deadline(FINALIZE_SECONDS);
    int waited = 0;
    while (!p->closed && waited != ETIMEDOUT)
        waited = may_hang ? pthread_cond_timedwait(&p->news, &p->lock, &until) : pthread_cond_wait(&p->news, &p->lock);
    bool closed = p->closed;
    pthread_mutex_unlock(&p->lock);
    if (!closed) return; /* its memory belongs to the thread until the process ends */
    pthread_join(p->thread, NULL);
    for (int r = 0; p->peers && r < p->place.size; r++)
        for (incoming *next, *in = p->peers[r].first; in; in = next) {
            next = in->next;
            free(in->message.body);
            free(in);
        }
    free(p->peers);
    free(p);
}

static ec_result lost(int rank, ec_error *err)
{
    ec_fail(err, "rank %d is lost: it has ended or cannot be reached", rank);
    if (err) err->kind = EC_ERROR_DEVICE;
    return EC_FAILED;
}

/* Called with the lock held. */
static void queue(ec_transport *p, outgoing *o, int to, const ec_message *message)
{
    *o = (outgoing){.to = to, .head = {.kind = message->kind, .box = message->box, .bytes = message->bytes}, .body = message->body};
    memcpy(o->head.numbers, message->numbers, sizeof o->head.numbers);
    outgoing **end = &p->to_send;
    while (*end) end = &(*end)->next;
    *end = o;
    pthread_cond_signal(&p->call);
}

ec_result ec_transport_send(ec_transport *p, int to, const ec_message *message, ec_error *err)
{
    outgoing o;
    pthread_mutex_lock(&p->lock);
    queue(p, &o, to, message);
    while (!o.done) pthread_cond_wait(&p->peers[to].news, &p->lock);
    pthread_mutex_unlock(&p->lock);
    return o.failed ? lost(to, err) : EC_OK;
}

void ec_transport_send_away(ec_transport *p, int to, ec_message *message)
{
    outgoing *o = malloc(sizeof *o);
    if (!o) {
        free(message->body); /* the receiver will notice that this rank is lost */
        return;
    }
    pthread_mutex_lock(&p->lock);
    queue(p, o, to, message);
    o->own = true;
    pthread_mutex_unlock(&p->lock);
}

/* Removes the first message of a box from the list. */
static incoming *take_message(peer *from, uint32_t box)
{
    incoming *before = NULL, *in = from->first;
    while (in && in->message.box != box) before = in, in = in->next;
    if (!in) return NULL;
    *(before ? &before->next : &from->first) = in->next;
    if (from->last == in) from->last = before;
    return in;
}

ec_result ec_transport_receive(ec_transport *p, int from, uint32_t box, bool (*go_on)(void *user), void *user, ec_message *message,
                          ec_error *err)
{
    incoming *in;
    bool waits = true;
    pthread_mutex_lock(&p->lock);
    while (!(in = take_message(&p->peers[from], box)) && !p->peers[from].lost && waits) {
        ec_transport_wait(p, &p->peers[from].news, ASKED_SECONDS);
        pthread_mutex_unlock(&p->lock);
        waits = !go_on || go_on(user);
        pthread_mutex_lock(&p->lock);
    }
    pthread_mutex_unlock(&p->lock);
    if (!in && !waits) return ec_fail(err, "stopped waiting");
    if (!in) return lost(from, err);
    *message = in->message;
    free(in);
    return EC_OK;
}

bool ec_transport_has(ec_transport *p, int from, uint32_t box)
{
    bool has = false;
    pthread_mutex_lock(&p->lock);
    for (const incoming *in = p->peers[from].first; in; in = in->next) has |= in->message.box == box;
    has |= p->peers[from].lost;
    pthread_mutex_unlock(&p->lock);
    return has;
}

uint64_t ec_transport_received(ec_transport *p)
{
    pthread_mutex_lock(&p->lock);
    const uint64_t received = p->received;
    pthread_mutex_unlock(&p->lock);
    return received;
}

ec_result ec_transport_spread(ec_transport *p, void *bytes, uint64_t count, uint32_t box, ec_error *err)
{
    const ec_rank_place *place = &p->place;
    for (uint64_t at = 0; at < count; at += EC_SPREAD_BYTES) {
        ec_message part = {.box = box, .bytes = count - at < EC_SPREAD_BYTES ? count - at : EC_SPREAD_BYTES, .body = (char *)bytes + at};
        if (place->parent >= 0) {
            ec_message come;
            EC_TRY(ec_transport_receive(p, place->parent, box, NULL, NULL, &come, err));
            const bool fits = come.bytes == part.bytes;
            if (fits) memcpy(part.body, come.body, come.bytes);
            free(come.body);
            if (!fits)
                return ec_fail(err, "rank %d sent %llu bytes instead of %llu", place->parent,
                               (unsigned long long)come.bytes, (unsigned long long)part.bytes);
        }
        for (int i = 0; i < place->children; i++) (void)ec_transport_send(p, place->first_child + i, &part, NULL); /* a lost child is found out later */
    }
    return EC_OK;
}
