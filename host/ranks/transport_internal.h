/* Shared by the halves of the transport: transport.c has the functions for those who send and receive messages, transport_thread.c owns MPI. Inside these two only. */
#ifndef EC_RANKS_TRANSPORT_INTERNAL_H
#define EC_RANKS_TRANSPORT_INTERNAL_H

#include <pthread.h>
#include <sys/types.h>

#include <mpi.h>

#include "base/clock.h"
#include "ranks/transport.h"

typedef struct head {
    uint32_t kind, box;
    uint64_t numbers[EC_MESSAGE_NUMBERS], bytes;
} head;

typedef struct outgoing {
    int to;
    head head;
    void *body;
    MPI_Request *requests;             /* for the head and the chunks */
    int request_count;
    bool begun, done, failed, own;     /* own: nobody waits for it; the transport frees it and its body */
    struct outgoing *next;
} outgoing;

typedef struct incoming {
    ec_message message;
    struct incoming *next;
} incoming;

typedef struct peer {
    incoming *first, *last;            /* complete messages, in order */
    incoming *open;                    /* the message whose body is arriving */
    uint64_t filled;                   /* bytes of it so far */
    head head;                         /* of the next message */
    MPI_Request request;
    bool receiving;                    /* a message is being received with `request` */
    double heard;                      /* time of the last message */
    pid_t process;                     /* its process, if it is on this host; 0: it is elsewhere, or invisible from here */
    bool lost;
    pthread_cond_t news;
} peer;

struct ec_transport {
    pthread_t thread;
    pthread_mutex_t lock;              /* guards everything below */
    pthread_cond_t call, news;         /* call: to the thread; news: from it */
    MPI_Comm comm;
    ec_rank_place place;
    peer *peers;                       /* by rank */
    outgoing *to_send;
    uint64_t received;                 /* bytes */
    double said_alive, lost_after;     /* seconds */
    bool open, closing, closed;
    ec_error error;                    /* why opening failed */
};

/* The thread: starts MPI, carries messages until the transport is closed, and ends MPI. */
void *ec_transport_run(void *transport);

/* Waits with the lock held, releasing it meanwhile. */
static inline void ec_transport_wait(ec_transport *p, pthread_cond_t *on, double seconds)
{
    const struct timespec until = ec_deadline(seconds);
    pthread_cond_timedwait(on, &p->lock, &until);
}

#endif
