/* Decides whether a loop over pixels is worth threads. */
#ifndef EC_FILM_THREADS_H
#define EC_FILM_THREADS_H

#include <stdbool.h>
#include <stdint.h>

bool ec_film_is_many(uint64_t pixels);

/* Says, for all renders of the process, whether cards alone render, so that the host's processors are free. */
void ec_film_beside_cards(bool cards_alone);

#endif
