/* Letters between the processes of an MPI job, its ranks. One thread owns MPI and all calls of it; others hand it letters and wait for
 * some. It looks for them every millisecond rather than spin as MPI's own calls do: the processor is for the renders. Internal to ranks/. */
#ifndef EC_RANKS_POST_H
#define EC_RANKS_POST_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

#define EC_LETTER_NUMBERS 12

typedef struct ec_letter {
    uint32_t kind;                        /* the sender's to choose; not EC_LETTER_ALIVE */
    uint32_t box;                         /* of the receiver: who waits for it there */
    uint64_t numbers[EC_LETTER_NUMBERS];
    uint64_t bytes;                       /* of the body */
    void *body;                           /* malloc'ed, the receiver's; NULL: none */
} ec_letter;

#define EC_LETTER_ALIVE UINT32_MAX

typedef struct ec_post ec_post;

/* Starts MPI, waits for all ranks. The post is to be closed on failure too, where it is not NULL. */
ec_result ec_post_open(ec_post **post, ec_error *err);
/* Ends MPI, together with the other ranks; gives up on that after a while where one was lost. NULL is fine. */
void ec_post_close(ec_post *post, bool is_any_lost);

/* Ranks are a tree with rank 0 at its root, so that nobody has more than EC_TREE_FANOUT + 1 others to talk to, however many there are: a rank
 * exchanges letters with its parent and its children alone. ECLAT_RANK_FANOUT sets another number, the same for all: for tests. */
#define EC_TREE_FANOUT 16
#define EC_SPREAD_BYTES (4u << 20) /* of one part of what goes to all: while a rank hands it on, the next one comes */
#define EC_LOST_SECONDS 60.0 /* without a sign of life of a rank until it is lost; ECLAT_RANK_LOST sets others, the same for all: for tests */

typedef struct ec_rank_place {
    int rank, size;
    int local_rank, local_size;    /* among those on this host */
    int parent;                    /* -1: it is the root */
    int first_child, children;     /* the children are numbered in a row */
} ec_rank_place;
const ec_rank_place *ec_post_place(const ec_post *post);

/* Returns when the letter and its body have been taken by MPI; they stay the caller's. Fails where the rank is lost. */
ec_result ec_post_send(ec_post *post, int to, const ec_letter *letter, ec_error *err);

/* Takes the body over and returns at once; whether it arrives shows in what the receiver does. */
void ec_post_send_away(ec_post *post, int to, ec_letter *letter);

/* The next letter of that rank in that box; waits for it, and fails where the rank is lost: MPI says so, or it is a process of this host that
 * has ended, or nothing has come of it for EC_LOST_SECONDS; or where go_on (NULL: no matter), asked twenty times a second, says no. */
ec_result ec_post_receive(ec_post *post, int from, uint32_t box, bool (*go_on)(void *user), void *user,
                          ec_letter *letter, ec_error *err);

/* Is there one in that box, or is the rank lost? */
bool ec_post_has(ec_post *post, int from, uint32_t box);

/* Bytes of all letters that have come so far, heads and signs of life too. */
uint64_t ec_post_received(ec_post *post);

/* Sends bytes of rank 0 to all ranks, as letters in that box: down the tree in parts. All are to call it. Fails where the parent is lost;
 * a child that is lost is left out. (MPI_Bcast would wait for it for ever.) */
ec_result ec_post_spread(ec_post *post, void *bytes, uint64_t count, uint32_t box, ec_error *err);

#endif
