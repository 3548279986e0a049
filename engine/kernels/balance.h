/* The linear system of one step of Newton's method for a cycle, and its memory. */
#ifndef GALLOPING_BALANCE_H
#define GALLOPING_BALANCE_H

#include "kernels.h"

/* The orders k = step n + lowest, n = 0, 1, ..., of some harmonics. Half a period of samples tells those of cycles that
 * alternate. */
typedef struct {
    int step, lowest;
    int count, kept;      /* of orders up to H; up to 2 H, padded to whole Lanes */
    int samples;          /* of the load that are needed, over a period or half of one */
    double *waves;        /* (samples / 2 + 1, 2 kept), cos and sin of k tau over the number of samples */
    Lanes *order, *known; /* (H) padded to whole Lanes: the orders but the mean, 0 beyond H, and 1, 1, ..., 0 beyond */
} Orders;

enum { EVERY, EVEN, ODD, KINDS };

typedef struct {
    int m, stretches, harmonics, size, samples;
    int coefficients, besides; /* m (2 H + 1), and the unknowns w and U after them */
    Orders kinds[KINDS];
    int alternates;      /* whether the unknowns are those of a cycle that does */
    int balances, unknowns, stride, groups; /* of the system: coefficients kept, all unknowns, groups of samples */
    int value_groups;    /* groups of samples of a whole period */
    int orders;          /* entries of half a spectrum, cosines or sines: k = -H ... 2 H, padded */
    int *kind;           /* (m), the kind of the orders of each coordinate */
    int *first;          /* (m), row and column of its first coefficient in the system: inactive coordinates first */
    int *kept;           /* (unknowns), where each one of the system stands among all coefficients, w and U */
    int *active;         /* (2 m), whether the load depends on this component of (q, q'/U) */
    double *folded;      /* (2, samples / 2 + 1), sums and differences of the samples at tau and -tau of one row */
    double *spectra;     /* (rows, 2 orders): of every row of the load */
    double *matrix;      /* (unknowns, stride), each row followed by its right sides */
    double **rows;       /* (unknowns), into the matrix */
    double *sizes;       /* (unknowns + LANES), scratch of the elimination */
    double *solution;    /* (2, unknowns), for both right sides */
    double *slope;       /* (m, 2 H + 1), coefficients of dq/dtau */
    double *x;           /* (coefficients and 2), the point, where the caller gives only its parts */
    Lanes *values;       /* (2 H + 1, value_groups), the basis at groups of samples, 0 beyond the last */
    Lanes *loads;        /* (rows, groups): f - g/U^2, its gradient, its derivative by w / U, and g/U^2 */
    Lanes *state, *scratch;
} System;

/* The rows of the load f - g/U^2: component i, its derivatives by component v of (q, q'/U) and by w/U, and g_i/U^2. */
static inline int force_row(int i) { return i; }
static inline int gradient_row(const System *w, int i, int v) { return w->m + i * 2 * w->m + v; }
static inline int rate_row(const System *w, int i) { return w->m + w->m * 2 * w->m + i; }
static inline int restoring_row(const System *w, int i) { return 2 * w->m * (1 + w->m) + i; }
static inline int row_count(const System *w) { return w->m * (3 + 2 * w->m); }

static inline const double *spectrum(const System *w, int row) { return w->spectra + row * 2 * w->orders + w->harmonics; }

/* Allocate memory for models of one shape with one or two unknowns, w and U, besides the coefficients; return 0 if memory
 * is short. */
int prepare_system(System *w, const Model *model, int harmonics, int besides);
void release_system(System *w);

/* Choose the unknowns, and order the coordinates so that those on which the load does not depend come first: their columns
 * are nearly empty. */
void arrange_system(System *w, const Model *model, int alternates);

/* Fill the rows of the balance at x (coefficients, w and U) with its slopes by the unknowns, and with the residual as the
 * first right side. */
void assemble_system(System *w, const Model *model, const double *x, double speed);

#endif
