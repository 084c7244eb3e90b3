/* Letters between the processes of an MPI job, its ranks. One thread owns MPI and makes all calls of it; others give it letters to send and wait for
 * some. It checks for them every millisecond instead of spinning as MPI's own calls do, as the processor is needed for rendering. Internal to ranks/. */
#ifndef EC_RANKS_POST_H
#define EC_RANKS_POST_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

#define EC_LETTER_NUMBERS 12

typedef struct ec_letter {
    uint32_t kind;                        /* chosen by the sender; not EC_LETTER_ALIVE */
    uint32_t box;                         /* of the receiver, where someone waits for it */
    uint64_t numbers[EC_LETTER_NUMBERS];
    uint64_t bytes;                       /* size of the body */
    void *body;                           /* malloc'ed, owned by the receiver; NULL: none */
} ec_letter;

#define EC_LETTER_ALIVE UINT32_MAX

typedef struct ec_post ec_post;

/* Starts MPI, and waits for all ranks. *post, if not NULL, must be closed on failure too. */
ec_result ec_post_open(ec_post **post, ec_error *err);
/* Ends MPI, together with the other ranks; gives up after a while if one was lost. NULL is fine. */
void ec_post_close(ec_post *post, bool is_any_lost);

/* Ranks form a tree with rank 0 at its root, in which a rank exchanges letters only with its parent and its children: at most EC_TREE_FANOUT + 1
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
const ec_rank_place *ec_post_place(const ec_post *post);

/* Sends a letter. Returns when MPI has taken it and its body, which remain the caller's. Fails if the rank is lost. */
ec_result ec_post_send(ec_post *post, int to, const ec_letter *letter, ec_error *err);

/* Sends a letter, takes over its body and returns at once; whether it arrives shows only in what the receiver does. */
void ec_post_send_away(ec_post *post, int to, ec_letter *letter);

/* Waits for the next letter of that rank in that box. Fails if the rank is lost (MPI says so, or its process on this host has ended, or nothing was
 * heard of it for EC_LOST_SECONDS), or if go_on (may be NULL), called twenty times per second, returns false. */
ec_result ec_post_receive(ec_post *post, int from, uint32_t box, bool (*go_on)(void *user), void *user,
                          ec_letter *letter, ec_error *err);

/* Tells whether there is a letter in that box, or the rank is lost. */
bool ec_post_has(ec_post *post, int from, uint32_t box);

/* Returns the bytes of all letters received so far, including heads and signs of life. */
uint64_t ec_post_received(ec_post *post);

/* Sends bytes of rank 0 to all ranks, as letters in that box, in parts down the tree. All ranks must call it. Fails if the parent is lost; a child
 * that is lost is left out, for which MPI_Bcast would wait for ever. */
ec_result ec_post_spread(ec_post *post, void *bytes, uint64_t count, uint32_t box, ec_error *err);

#endif
