/* Several sources as one: each is worked by a thread of its own, which asks for the next piece of a batch when it is free. Pieces are handed
 * out in the order of batches and positions; batches come out in order, whoever took what, so that they are those of one source.
 *
 * A piece is what its source does in the time that the team takes for as many batches as it has members, a second at most, a wave at least:
 * whole batches where these are short, and fewer pixels for the slow. Towards the end pieces get smaller, so that nobody waits long.
 *
 * So that nobody waits for a batch that is late, so many may be open at once as there are members and one more, 12 bytes a pixel each; two
 * where that would be over EC_TEAM_ROOM.
 *
 * A member that fails is out, and its piece goes to another. */
#ifndef EC_PIPELINE_TEAM_H
#define EC_PIPELINE_TEAM_H

#include "pipeline/batch_source.h"

#define EC_TEAM_ROOM ((uint64_t)1 << 29) /* bytes */

/* How many batches of such an image a team of so many may have open. */
uint32_t ec_team_window(uint32_t members, uint64_t pixels);

typedef struct ec_team_recruit {
    const char *name;                 /* for messages */
    /* Called by the member's thread. *source is closed by the team, on failure too if it is not NULL. */
    ec_result (*open)(void *user, ec_batch_source **source, ec_error *err);
    void *user;
    uint32_t processes;               /* that it stands for, beside this one */
} ec_team_recruit;

typedef struct ec_team ec_team;

/* Starts the threads. log gets a warning for each member that fails while there are others. */
ec_result ec_team_open(const ec_team_recruit *recruits, uint32_t count, uint32_t width, uint32_t height, const ec_log *log, ec_team **team,
                       ec_error *err);
/* Until one of the first so many members is ready, or all of these have failed. */
void ec_team_wait(ec_team *team, uint32_t count);
/* What to take batches from. Takes fail once all members have. Closing it ends the threads, each after the wave that it is in. */
ec_batch_source *ec_team_source(ec_team *team);

/* Pixels in pieces that member i has finished; may it still take more? */
uint64_t ec_team_share(const ec_team *team, uint32_t i, bool *has_failed);

void ec_team_free(ec_team *team); /* closes it if need be; NULL is fine */

#endif
