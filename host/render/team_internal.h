/* State that both parts of a team share: team.c has the threads and the orders, team_pieces.c knows which units are open and which member gets which piece.
 * Inside these two only; everything is guarded by the team's lock. */
#ifndef EC_RENDER_TEAM_INTERNAL_H
#define EC_RENDER_TEAM_INTERNAL_H

#include <pthread.h>

#include "render/team.h"

/* An open unit: a batch, or a block of batches. Some of its positions are done, [handed, count) wait, and members hold the others. */
typedef struct slot {
    ec_order_light light;
    uint32_t index, batches;          /* `batches` batches from `index` on */
    uint32_t cut, samples;            /* as in the order: samples that it lacks at its end; samples of each entry of a list */
    float limit;                      /* likewise */
    const uint32_t *list;
    uint32_t feature_sets;            /* of the order */
    float *mean, *features, *layers;  /* of a batch: EC_BATCH_FIELDS and EC_AOV_FIELDS a position; the order's layers */
    ec_matte_log *matte;              /* of the order */
    ec_sums sums;                     /* of a block: of positions from `from` on */
    uint32_t from, count, handed;
    uint32_t invalid[EC_STAGE_COUNT];
} slot;

typedef struct member {
    ec_team *team;
    ec_team_candidate candidate;
    pthread_t thread;
    ec_batch_source *source;
    bool has_thread, is_ready, is_busy, has_failed, is_told;
    slot *slot;                       /* the unit whose piece [first, end) the member holds; NULL: none. Others take over that of a failed member */
    uint32_t first, end, reached;
    uint32_t pieces;
    double samples;                   /* in finished pieces */
    double rate, seconds;             /* samples a second of the last piece, and its seconds; 0: not known */
    uint64_t rays;
    uint32_t invalid[EC_STAGE_COUNT]; /* the source's, before the piece */
    ec_error why;
} member;

struct ec_team {
    ec_batch_source base;
    member *members;
    uint32_t count, width, replicates;
    uint64_t pixels;
    const ec_log *log;
    pthread_mutex_t lock;
    pthread_cond_t work, news;        /* for members; for the thread that takes batches */
    slot *slots;                      /* unit i is in slots[i % room]; units are counted as they are opened */
    uint32_t room, next, opened;      /* [next, opened) are open */
    uint32_t from, end;               /* batches [from, end) may be opened next … */
    uint32_t step, done, last;        /* … so many at once (0: as many as suits), for positions [done, last) */
    float limit;                      /* of the order */
    uint32_t feature_sets;            /* likewise */
    bool is_out;                      /* unit `next` has been handed out */
    uint64_t rays;                    /* traced in finished pieces */
    bool sends;                       /* pieces of some members come from afar, and blocks are worth it */
    uint32_t (*whole)(const void *user, uint32_t index); /* of the order; NULL: no blocks */
    const void *user;
    double patience, until;
    bool stops;
};

uint32_t ec_team_alive(const ec_team *team);

/* Opens the unit that the order begins with, after all open ones; returns false if there is no memory. */
bool ec_team_open_unit(ec_team *team, const ec_batch_order *order);

/* Finds the next piece for a member and sets m->slot; returns false if there is none now. */
bool ec_team_find_piece(member *m);

/* Settles the piece that the member held. */
void ec_team_settle(member *m, ec_result result, bool complete, double seconds);

/* Returns the samples of each position of a unit. */
double ec_team_samples(const ec_team *team, const slot *s);

/* Returns the position up to which all of a unit is done. */
uint32_t ec_team_done(const ec_team *team, const slot *s);

/* Frees the units of slots that are not open. */
void ec_team_free_units(ec_team *team);

#endif
