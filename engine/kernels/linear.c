/* Dense linear systems of a few dozen unknowns, for which the overhead of a LAPACK call would dominate.
 *
 * Two columns are eliminated at a time, so each row is read and written half as often. The magnitudes in the next column
 * are stored as they are computed, since a separate search for the pivot would load every row again. */
#include "kernels.h"

#include <math.h>

/* Swap the row with the largest of `sizes`, from row k on, into place k and return it; NULL if all are zero. */
WITHIN double *choose_pivot(int n, int k, double **rows, double *sizes)
{
    double largest[LANES] = {0};
    for (int i = k; i < n; i += LANES)
        for (int lane = 0; lane < LANES; lane++)
            largest[lane] = sizes[i + lane] > largest[lane] ? sizes[i + lane] : largest[lane];
    double size = 0.0;
    for (int lane = 0; lane < LANES; lane++)
        size = largest[lane] > size ? largest[lane] : size;
    int best = k;
    while (best < n && sizes[best] != size)
        best++;
    if (best == n || size == 0.0)
        return NULL;
    double *pivot = rows[best];
    rows[best] = rows[k];
    rows[k] = pivot;
    return pivot;
}

WITHIN void subtract(int first, int end, const double *pivot, double factor, double *row)
{
    for (int j = first; j < end; j += LANES)
        *(Lanes *)(row + j) -= factor * *(const Lanes *)(pivot + j);
}

/* Subtract multiples of two rows, p and q, from two others. */
WITHIN void subtract_both(int first, int end, const double *p, const double *q, double *a, double *b, const double *by)
{
    for (int j = first; j < end; j += LANES) {
        const Lanes here = *(const Lanes *)(p + j), next = *(const Lanes *)(q + j);
        *(Lanes *)(a + j) = (*(const Lanes *)(a + j) - by[0] * here) - by[1] * next;
        *(Lanes *)(b + j) = (*(const Lanes *)(b + j) - by[2] * here) - by[3] * next;
    }
}

/* Eliminate column k from the rows below and replace the pivot by its inverse. */
WITHIN int eliminate_one(int n, int end, int k, double **rows, double *sizes)
{
    double *pivot = choose_pivot(n, k, rows, sizes);
    if (!pivot)
        return 0;
    pivot[k] = 1.0 / pivot[k];
    for (int i = k + 1; i < n; i++) {
        if (rows[i][k] != 0.0)
            subtract(k + 1, end, pivot, rows[i][k] * pivot[k], rows[i]);
        sizes[i] = fabs(rows[i][k + 1]);
    }
    return 1;
}

/* Eliminate columns k and k + 1 likewise. */
WITHIN int eliminate_two(int n, int end, int k, double **rows, double *sizes)
{
    double *p = choose_pivot(n, k, rows, sizes);
    if (!p)
        return 0;
    p[k] = 1.0 / p[k];
    for (int i = k + 1; i < n; i++) {
        rows[i][k] *= p[k];
        rows[i][k + 1] -= rows[i][k] * p[k + 1];
        sizes[i] = fabs(rows[i][k + 1]);
    }
    double *q = choose_pivot(n, k + 1, rows, sizes);
    if (!q)
        return 0;
    q[k + 1] = 1.0 / q[k + 1];
    subtract(k + 2, end, p, q[k], q);
    int i = k + 2;
    for (; i + 1 < n; i += 2) {
        double *a = rows[i], *b = rows[i + 1];
        const double by[] = {a[k], a[k + 1] * q[k + 1], b[k], b[k + 1] * q[k + 1]};
        if (by[0] != 0.0 || by[1] != 0.0 || by[2] != 0.0 || by[3] != 0.0)
            subtract_both(k + 2, end, p, q, a, b, by);
        sizes[i] = fabs(a[k + 2]), sizes[i + 1] = fabs(b[k + 2]);
    }
    if (i < n) {
        subtract(k + 2, end, p, rows[i][k], rows[i]);
        subtract(k + 2, end, q, rows[i][k + 1] * q[k + 1], rows[i]);
        sizes[i] = fabs(rows[i][k + 2]);
    }
    return 1;
}

/* Substitute back for LANES unknowns at a time: their sums over the unknowns already solved are independent. */
WITHIN void substitute_back(int n, int side, double **rows, double *x)
{
    for (int stop = n; stop > 0; stop -= LANES) {
        const int start = stop > LANES ? stop - LANES : 0;
        double rest[LANES];
        for (int k = start; k < stop; k++) {
            Lanes sum = {0};
            for (int j = stop; j < n; j += LANES)
                sum += *(const Lanes *)(rows[k] + j) * *(const Lanes *)(x + j);
            rest[k - start] = rows[k][side] - ((sum[0] + sum[1]) + (sum[2] + sum[3]));
        }
        for (int k = stop - 1; k >= start; k--) {
            x[k] = rest[k - start] * rows[k][k];
            for (int i = start; i < k; i++)
                rest[i - start] -= rows[i][k] * x[k];
        }
    }
}

WIDE int eliminate(int n, double **rows, int sides, double *sizes, double *x)
{
    const int end = n + sides;
    for (int i = 0; i < n + LANES; i++)
        sizes[i] = i < n ? fabs(rows[i][0]) : 0.0;
    if (!eliminate_one(n, end, 0, rows, sizes))
        return 0;
    int k = 1;
    for (; k + 1 < n; k += 2)
        if (!eliminate_two(n, end, k, rows, sizes))
            return 0;
    if (k < n && !eliminate_one(n, end, k, rows, sizes))
        return 0;
    for (int side = 0; side < sides; side++)
        substitute_back(n, n + side, rows, x + side * n);
    return 1;
}
