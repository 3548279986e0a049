/* Dense linear systems of some dozen unknowns, too small for the overhead of a call to LAPACK to be small. */
#include "kernels.h"

#include <math.h>

static inline int largest(int n, int column, double *const *rows)
{
    int best = column;
    for (int i = column + 1; i < n; i++)
        if (fabs(rows[i][column]) > fabs(rows[best][column]))
            best = i;
    return best;
}

WIDE int factorize(int n, double **rows, int *pivots)
{
    for (int k = 0; k < n; k++) {
        const int best = largest(n, k, rows);
        double *pivot = rows[best];
        pivots[k] = best;
        rows[best] = rows[k];
        rows[k] = pivot;
        if (pivot[k] == 0.0)
            return 0;
        const double inverse = 1.0 / pivot[k];
        for (int i = k + 1; i < n; i++) {
            double *restrict row = rows[i];
            if (row[k] == 0.0)
                continue;
            const double factor = row[k] *= inverse;
            for (int j = k + 1; j < n; j++)
                row[j] -= factor * pivot[j];
        }
    }
    return 1;
}

WIDE void substitute(int n, double *const *rows, const int *pivots, double *x)
{
    for (int k = 0; k < n; k++) {
        const double swapped = x[pivots[k]];
        x[pivots[k]] = x[k];
        x[k] = swapped;
    }
    for (int i = 1; i < n; i++)
        for (int j = 0; j < i; j++)
            x[i] -= rows[i][j] * x[j];
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            x[i] -= rows[i][j] * x[j];
        x[i] /= rows[i][i];
    }
}
