/* Messages between the processes of an MPI job, its ranks. One thread owns MPI and makes all calls of it; others give it messages to send and wait for
 * some. It checks for them every millisecond instead of spinning as MPI's own calls do, as the processor is needed for rendering. Internal to ranks/. */
#ifndef EC_RANKS_TRANSPORT_H
#define EC_RANKS_TRANSPORT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

#define EC_MESSAGE_NUMBERS 12

typedef struct ec_message {
    uint32_t kind;                        /* chosen by the sender; not EC_MESSAGE_ALIVE */
    uint32_t box;                         /* of the receiver, where someone waits for it */
    uint64_t numbers[EC_MESSAGE_NUMBERS];
    uint64_t bytes;                       /* size of the body */
    void *body;                           /* malloc'ed, owned by the receiver; NULL: none */
} ec_message;

#define EC_MESSAGE_ALIVE UINT32_MAX

typedef struct ec_transport ec_transport;

/* Starts MPI, and waits for all ranks. *transport, if not NULL, must be closed on failure too. */
ec_result ec_transport_open(ec_transport **transport, ec_error *err);
/* Ends MPI, together with the other ranks; gives up after a while if one was lost. NULL is fine. */
void ec_transport_close(ec_transport *transport, bool is_any_lost);

/* Ranks form a tree with rank 0 at its root, in which a rank exchanges messages only with its parent and its children: at most EC_TREE_FANOUT + 1
 * others, for any number of ranks. For tests, ECLAT_RANK_FANOUT sets another number, which must be the same on all ranks. */
#define EC_TREE_FANOUT 16
#define EC_SPREAD_BYTES (4u << 20) /* size of a part of what is sent to all: a rank passes one on while the next one arrives */
#define EC_LOST_SECONDS 60.0 /* silence after which a rank is lost; for tests, ECLAT_RANK_LOST sets another, the same on all ranks */

typedef struct ec_rank_place {
    int rank, size;
    int local_rank, local_size;    /* among those on this host */
    int parent;                    /* -1: this is the root */
    int first_child, children;     /* children have consecutive numbers */
} ec_rank_place;
const ec_rank_place *ec_transport_place(const ec_transport *transport);

/* Sends a message. Returns when MPI has taken it and its body, which remain the caller's. Fails if the rank is lost. */
ec_result ec_transport_send(ec_transport *transport, int to, const ec_message *message, ec_error *err);

/* Sends a message, takes over its body and returns at once; whether it arrives shows only in what the receiver does. */
void ec_transport_send_away(ec_transport *transport, int to, ec_message *message);

/* Waits for the next message of that rank in that box. Fails if the rank is lost (MPI says so, or its process on this host has ended, or nothing was
 * heard of it for EC_LOST_SECONDS), or if go_on (may be NULL), called twenty times per second, returns false. */
ec_result ec_transport_receive(ec_transport *transport, int from, uint32_t box, bool (*go_on)(void *user), void *user,
                          ec_message *message, ec_error *err);

/* Tells whether there is a message in that box, or the rank is lost. */
bool ec_transport_has(ec_transport *transport, int from, uint32_t box);

/* Returns the bytes of all messages received so far, including heads and signs of life. */
uint64_t ec_transport_received(ec_transport *transport);

/* Sends bytes of rank 0 to all ranks, as messages in that box, in parts down the tree. All ranks must call it. Fails if the parent is lost; a child
 * that is lost is left out, for which MPI_Bcast would wait for ever. */
ec_result ec_transport_spread(ec_transport *transport, void *bytes, uint64_t count, uint32_t box, ec_error *err);

#endif
