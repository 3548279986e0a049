/* Dense linear systems of some dozen unknowns, too small for the overhead of a call to LAPACK to be small. */
#include "kernels.h"

#include <math.h>

static inline int largest(int n, int column, double *const *rows)
{
    int best = column;
    double size = fabs(rows[column][column]);
    for (int i = column + 1; i < n; i++) {
        const double other = fabs(rows[i][column]);
        if (other > size) {
            size = other;
            best = i;
        }
    }
    return best;
}

WIDE int eliminate(int n, double **rows, int sides)
{
    for (int k = 0; k < n; k++) {
        const int best = largest(n, k, rows);
        double *pivot = rows[best];
        rows[best] = rows[k];
        rows[k] = pivot;
        if (pivot[k] == 0.0)
            return 0;
        const double inverse = 1.0 / pivot[k];
        for (int i = k + 1; i < n; i++) {
            double *row = rows[i];
            const double factor = row[k] * inverse;
            if (factor == 0.0)
                continue;
            for (int j = k + 1; j < n + sides; j += LANES)
                *(Lanes *)(row + j) -= factor * *(const Lanes *)(pivot + j);
        }
    }
    for (int side = n; side < n + sides; side++)
        for (int k = n - 1; k >= 0; k--) {
            const double x = rows[k][side] /= rows[k][k];
            for (int i = 0; i < k; i++)
                rows[i][side] -= rows[i][k] * x;
        }
    return 1;
}
