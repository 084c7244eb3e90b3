/* Several sources as one: each is worked by a thread of its own, which asks for the next piece of a batch when it is free. Pieces are handed
 * out in the order of batches and positions; batches come out in order, whoever took what, so that they are those of one source.
 *
 * A piece is what its source does in the time that the team takes for as many batches as it has members, a second at most, a wave at least:
 * whole batches where these are short, and fewer pixels for the slow. Towards the end pieces get smaller, so that nobody waits long.
 *
 * Where pieces come from afar and batches fast, a unit may be a block, of 128 or 2048 batches (film/parts.h): a piece is then rows of all of
 * them, what comes back are their sums, ec_sums_bytes a pixel in place of 24 for each batch. A block is only begun where the paces that were measured say
 * that it is over within the order's patience.
 *
 * A block that a team is ordered to take, as another's member, is made of units of a sixteenth of it.
 *
 * So that nobody waits for a unit that is late, so many may be open at once as there are members, with all the processes that they stand for,
 * and one more, if they fit into EC_TEAM_ROOM, and two in any case. Pieces of blocks that are on
 * their way take as much again.
 *
 * A member that fails is out, and its piece goes to another. */
#ifndef EC_RENDER_TEAM_H
#define EC_RENDER_TEAM_H

#include "device/batch_source.h"

#define EC_TEAM_ROOM ((uint64_t)1 << 29)  /* most bytes of open units, unless two need more */
#define EC_TEAM_PIECE ((uint64_t)1 << 25) /* bytes of a block's piece, unless it is one wave */
#define EC_TEAM_PIECE_SECONDS 1.0         /* at most, unless it is one wave */
#define EC_TEAM_PATIENCE_SECONDS 3.0      /* seconds that a block may take, or … */
#define EC_TEAM_PATIENCE_SHARE 0.01       /* … of the time so far */

/* Return how many units of so many bytes a pixel a team may have open; and the bytes for them, with so many sets of features, if some of its pieces
 * come from afar. */
uint32_t ec_team_window(uint32_t members, uint64_t pixels, uint64_t bytes);
uint64_t ec_team_bytes(uint32_t members, uint64_t pixels, uint32_t replicates, uint32_t sets, bool from_afar);

typedef struct ec_team_candidate {
    const char *name;                 /* for messages */
    /* Called in the member's thread. The team closes *source, even on failure if it is not NULL. */
    ec_result (*open)(void *user, ec_batch_source **source, ec_error *err);
    void *user;
    uint32_t processes;               /* other processes that it stands for: its pieces come from afar then */
} ec_team_candidate;

typedef struct ec_team ec_team;

/* Starts the threads. log gets a warning for each member that fails while there are others. */
ec_result ec_team_open(const ec_team_candidate *candidates, uint32_t count, uint32_t width, uint32_t height,
                       uint32_t replicates, const ec_log *log, ec_team **team, ec_error *err);
/* Leaves out a member that has failed at something else, while nothing was ordered: the next take reports it. */
void ec_team_leave_out(ec_team *team, uint32_t member, const ec_error *why);
/* Returns whether a member has been loaded, and has not failed since. waits: waits until that is known. */
bool ec_team_is_ready(ec_team *team, uint32_t member, bool waits);
/* Waits until one of the first `count` members is ready, or all of these have failed. */
void ec_team_wait(ec_team *team, uint32_t count);
/* Returns the source to take batches from. Takes fail once all members have. Closing it ends the threads, each after the wave that it is in. */
ec_batch_source *ec_team_source(ec_team *team);

/* Returns the samples in pieces that member i has finished; *has_failed: it takes no more. */
double ec_team_share(const ec_team *team, uint32_t i, bool *has_failed);

void ec_team_free(ec_team *team); /* closes it if need be; NULL is fine */

#endif
