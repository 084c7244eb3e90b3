/* A pixel's squared standard error, improved by those of its neighbours. borrowed.c has the method. */
#ifndef EC_FILM_BORROWED_H
#define EC_FILM_BORROWED_H

#include <stdint.h>

enum { EC_BORROWED_MOST = 24, EC_BORROWED_STEPS = 4 }; /* degrees of freedom that neighbours add; entries of the table for each */

/* For pixels of so many replicates. */
typedef struct ec_borrower {
    uint32_t replicates; /* 0: not made yet */
    double spread;       /* the variance of ln SE^2 where all pixels have the same truth */
    double bias;         /* the mean of ln SE^2 less the logarithm of the truth */
    double t[EC_BORROWED_MOST * EC_BORROWED_STEPS + 2]; /* Student's 97.5 % quantiles by degrees of freedom */
} ec_borrower;

ec_borrower ec_borrower_of(uint32_t replicates);

/* ln SE^2 of neighbours: the sums of its first and second powers, not finite where one of them has no noise. */
typedef struct ec_neighbours {
    double count, sum, squares;
} ec_neighbours;

/* Returns the degrees of freedom of a pixel's SE^2 with what its neighbours add: its own R - 1 and up to EC_BORROWED_MOST. */
double ec_borrowed_freedom(const ec_borrower *borrower, const ec_neighbours *neighbours);

/* The plain 95 % interval of a pixel reaches from its mean by t standard errors to both sides. */
typedef struct ec_reach {
    double t, se;
} ec_reach;

/* Returns the reach for a pixel whose squared standard error is se2. The neighbours do not include it. */
ec_reach ec_borrowed_reach(const ec_borrower *borrower, double se2, const ec_neighbours *neighbours);

#endif
