/* The linear system of one step of Newton's method for a cycle, and its memory. */
#ifndef GALLOPING_BALANCE_H
#define GALLOPING_BALANCE_H

#include "kernels.h"

typedef struct {
    int m, stretches, harmonics, size, balances, unknowns, stride, samples, groups;  /* balances = m (2 H + 1) */
    int waves_kept;      /* number of cos k tau, k = 0 ... 2 H, padded to whole Lanes; sin k tau likewise */
    int orders;          /* entries of half a spectrum, cosines or sines: k = -H ... 2 H, padded */
    int *place;          /* (unknowns), row and column of each in the system: inactive coordinates first */
    int *active;         /* (2 m), whether the load depends on this component of (q, q'/U) */
    double *waves;       /* (samples / 2 + 1, 2 waves_kept), cos and sin of k tau over the number of samples */
    double *folded;      /* (2, samples / 2 + 1), sums and differences of the samples at tau and -tau of one row */
    double *spectra;     /* (rows, 2 orders): of every row of the load */
    Lanes *order, *known; /* (H) padded to whole Lanes: 1, 2, ..., H, 0 beyond, and 1, 1, ..., 1, 0 beyond */
    double *matrix;      /* (unknowns, stride), each row followed by its right sides */
    double **rows;       /* (unknowns), into the matrix */
    double *sizes;       /* (unknowns + LANES), scratch of the elimination */
    double *solution;    /* (2, unknowns), for both right sides, in the order of elimination */
    double *slope;       /* (m, 2 H + 1), coefficients of dq/dtau */
    double *x;           /* (unknowns), the point, where the caller gives only its parts */
    Lanes *values;       /* (2 H + 1, groups), the basis at groups of samples, 0 beyond the last */
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

/* Order the coordinates so that those on which the load does not depend come first: their columns are nearly empty. */
void arrange_system(System *w, const Model *model);

/* Fill the rows of the balance at x with its slopes by the coefficients, by w and, if it is unknown, by U, and with the
 * residual as the first right side. */
void assemble_system(System *w, const Model *model, const double *x, double speed);

#endif
