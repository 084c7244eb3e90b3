#include "film/threads.h"

#include <stdatomic.h>

/* Idle threads spin for some milliseconds after each loop (libgomp), which costs a device that is a processor more than small loops gain. On an
 * H100 with 16 cores beside it, a 512x512 render of 64 samples left the card idle for three quarters of its time without threads. */
enum { BESIDE_PROCESSORS = 1 << 18, BESIDE_CARDS = 1 << 14 };

static atomic_uint many = BESIDE_PROCESSORS;

bool ec_film_is_many(uint64_t pixels) { return pixels > atomic_load_explicit(&many, memory_order_relaxed); }

void ec_film_beside_cards(bool cards_alone)
{
    atomic_store_explicit(&many, cards_alone ? BESIDE_CARDS : BESIDE_PROCESSORS, memory_order_relaxed);
}
