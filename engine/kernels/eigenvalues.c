/* Eigenvalues of small real matrices, for which the calls of LAPACK take longer than its arithmetic: balancing by powers of
 * two, Householder's reduction to Hessenberg form, and Francis's double-shift QR steps that deflate as LAPACK's dlahqr does
 * (Ahues and Tisseur 1997). Where a matrix is too far from 1 for plain squares, or the steps do not converge, the result is
 * NaN and the caller asks LAPACK. */
#include "kernels.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define SMALLEST 1e-100 /* sizes of the largest entry between which squares neither overflow nor vanish */
#define LARGEST 1e100
#define VANISHING 1e-280 /* squares of a vector's length below which it is not normalized */
enum { STEPS = 30, EXCEPTIONAL = 10 }; /* steps for each eigenvalue, and after how many in vain the shift is another */

typedef struct {
    int n, stride; /* rows are padded with zeros to whole Lanes */
    double *h;     /* (n, stride) */
} Matrix;

/* I - factor v v^T with v = (1, second, third), which turns a vector into (length, 0, 0). */
typedef struct {
    double factor, second, third, length;
} Reflection;

WITHIN double *row_of(const Matrix *a, int i) { return a->h + (ptrdiff_t)i * a->stride; }
WITHIN double entry(const Matrix *a, int i, int j) { return a->h[(ptrdiff_t)i * a->stride + j]; }

/* Multiply column i by a factor and row i by its inverse. */
WITHIN void rescale(const Matrix *a, int i, double factor)
{
    for (int j = 0; j < a->n; j++) {
        row_of(a, i)[j] /= factor;
        row_of(a, j)[i] *= factor;
    }
}

/* Scale the basis vectors by powers of two until no row is much longer or shorter than its column (Parlett and Reinsch). */
WITHIN void balance(const Matrix *a)
{
    for (int again = 1; again;) {
        again = 0;
        for (int i = 0; i < a->n; i++) {
            double column = 0.0, row = 0.0, factor = 1.0;
            for (int j = 0; j < a->n; j++) {
                column += entry(a, j, i) * entry(a, j, i);
                row += entry(a, i, j) * entry(a, i, j);
            }
            const double largest = column > row ? column : row, least = column > row ? row : column;
            if (!(least > 0.0) || !(largest > 5.5 * least)) /* a factor of two would shorten their sum by less than 5 % */
                continue;
            for (; row > 5.5 * column; row /= 4.0, column *= 4.0)
                factor *= 2.0;
            for (; column > 5.5 * row; column /= 4.0, row *= 4.0)
                factor /= 2.0;
            rescale(a, i, factor);
            again = 1;
        }
    }
}

/* Eliminate the entries below the subdiagonal, column by column. Return 0 if a column is too short to be normalized. */
WITHIN int reduce(const Matrix *a, double *v, double *sums)
{
    const int n = a->n;
    for (int k = 0; k + 2 < n; k++) {
        double below = 0.0;
        for (int i = k + 2; i < n; i++)
            below += entry(a, i, k) * entry(a, i, k);
        if (below == 0.0)
            continue;
        if (below < VANISHING)
            return 0;
        const double first = entry(a, k + 1, k), length = -copysign(sqrt(first * first + below), first);
        const double factor = (length - first) / length, inverse = 1.0 / (first - length);
        for (int j = 0; j < a->stride; j++)
            v[j] = sums[j] = 0.0;
        v[k + 1] = 1.0;
        for (int i = k + 2; i < n; i++)
            v[i] = entry(a, i, k) * inverse;
        for (int i = k + 1; i < n; i++)
            for (int j = 0; j < a->stride; j += LANES)
                *(Lanes *)(sums + j) += v[i] * *(const Lanes *)(row_of(a, i) + j);
        for (int i = k + 1; i < n; i++)
            for (int j = 0; j < a->stride; j += LANES)
                *(Lanes *)(row_of(a, i) + j) -= factor * v[i] * *(const Lanes *)(sums + j);
        for (int i = 0; i < n; i++) {
            double *row = row_of(a, i);
            Lanes all = {0};
            for (int j = 0; j < a->stride; j += LANES)
                all += *(const Lanes *)(row + j) * *(const Lanes *)(v + j);
            const double sum = factor * ((all[0] + all[1]) + (all[2] + all[3]));
            for (int j = 0; j < a->stride; j += LANES)
                *(Lanes *)(row + j) -= sum * *(const Lanes *)(v + j);
        }
        row_of(a, k + 1)[k] = length;
        for (int i = k + 2; i < n; i++)
            row_of(a, i)[k] = 0.0;
    }
    return 1;
}

/* Return whether the subdiagonal entry of row k is negligible. */
WITHIN int negligible(const Matrix *a, int k)
{
    const double size = fabs(entry(a, k, k - 1)), smallest = DBL_MIN * a->n / DBL_EPSILON;
    const double before = entry(a, k - 1, k - 1), here = entry(a, k, k);
    if (size <= smallest)
        return 1;
    double near = fabs(before) + fabs(here);
    if (near == 0.0)
        near = (k > 1 ? fabs(entry(a, k - 1, k - 2)) : 0.0) + (k + 1 < a->n ? fabs(entry(a, k + 1, k)) : 0.0);
    if (size > DBL_EPSILON * near)
        return 0;
    const double above = fabs(entry(a, k - 1, k)), gap = fabs(before - here), own = fabs(here);
    const double wide = size > above ? size : above, narrow = size > above ? above : size;
    const double long_one = own > gap ? own : gap, short_one = own > gap ? gap : own;
    const double sum = long_one + wide, limit = DBL_EPSILON * (short_one * (long_one / sum));
    return narrow * (wide / sum) <= (limit > smallest ? limit : smallest);
}

/* Write the eigenvalues of ((a, b), (c, d)) as pairs of real and imaginary part. */
WITHIN void solve_pair(double a, double b, double c, double d, double *values)
{
    const double half = 0.5 * (a - d), square = half * half + b * c, middle = 0.5 * (a + d);
    if (square < 0.0) {
        values[0] = values[2] = middle;
        values[1] = sqrt(-square);
        values[3] = -values[1];
        return;
    }
    const double far = half + copysign(sqrt(square), half); /* from d, without cancellation */
    values[0] = d + far;
    values[2] = far == 0.0 ? d : d - b * c / far;
    values[1] = values[3] = 0.0;
}

/* Find the shifts from the last two rows, or other ones after steps in vain; a pair of real ones is the nearer one twice. */
WITHIN void find_shifts(const Matrix *a, int first, int last, int vain, double *shifts)
{
    double upper = entry(a, last - 1, last - 1), lower = entry(a, last, last);
    double right = entry(a, last - 1, last), left = entry(a, last, last - 1);
    if (vain && vain % EXCEPTIONAL == 0) {
        const int at = vain % (2 * EXCEPTIONAL) ? first : last - 2;
        left = fabs(entry(a, at + 1, at)) + fabs(entry(a, at + 2, at + 1));
        upper = lower = 0.75 * left + (vain % (2 * EXCEPTIONAL) ? entry(a, first, first) : lower);
        right = -0.4375 * left;
    }
    solve_pair(upper, right, left, lower, shifts);
    if (shifts[1] == 0.0)
        shifts[0] = shifts[2] = fabs(shifts[0] - lower) <= fabs(shifts[2] - lower) ? shifts[0] : shifts[2];
}

/* Return the row from which a double step may begin, at two small subdiagonal entries in a row, and its first vector v. */
WITHIN int find_begin(const Matrix *a, int first, int last, const double *shifts, double *v)
{
    for (int k = last - 2;; k--) {
        const double here = entry(a, k, k), next = entry(a, k + 1, k + 1);
        const double size = fabs(here - shifts[2]) + fabs(shifts[3]) + fabs(entry(a, k + 1, k));
        const double below = entry(a, k + 1, k) / size;
        v[0] = below * entry(a, k, k + 1) + (here - shifts[0]) * ((here - shifts[2]) / size) - shifts[1] * (shifts[3] / size);
        v[1] = below * (here + next - shifts[0] - shifts[2]);
        v[2] = below * entry(a, k + 2, k + 1);
        const double inverse = 1.0 / (fabs(v[0]) + fabs(v[1]) + fabs(v[2]));
        for (int i = 0; i < 3; i++)
            v[i] *= inverse;
        if (k == first)
            return k;
        const double around = fabs(entry(a, k - 1, k - 1)) + fabs(here) + fabs(next);
        if (fabs(entry(a, k, k - 1)) * (fabs(v[1]) + fabs(v[2])) <= DBL_EPSILON * fabs(v[0]) * around)
            return k;
    }
}

WITHIN Reflection reflection_of(double first, double second, double third)
{
    const double rest = second * second + third * third;
    if (rest == 0.0)
        return (Reflection){0.0, 0.0, 0.0, first};
    const double length = -copysign(sqrt(first * first + rest), first), inverse = 1.0 / (first - length);
    return (Reflection){(length - first) / length, second * inverse, third * inverse, length};
}

/* Apply a reflection of rows and columns k, k + 1 and, if there are three, k + 2. Rows may be changed over their whole
 * lengths: what lies outside the block is zero or no longer needed. */
WITHIN void reflect(const Matrix *a, int first, int last, int k, int three, Reflection by)
{
    double *top = row_of(a, k), *middle = row_of(a, k + 1), *bottom = row_of(a, three ? k + 2 : k + 1);
    const double second = by.factor * by.second, third = by.factor * by.third;
    for (int j = k / LANES * LANES; j < a->stride; j += LANES) {
        Lanes sum = *(const Lanes *)(top + j) + by.second * *(const Lanes *)(middle + j);
        if (three) {
            sum += by.third * *(const Lanes *)(bottom + j);
            *(Lanes *)(bottom + j) -= third * sum;
        }
        *(Lanes *)(top + j) -= by.factor * sum;
        *(Lanes *)(middle + j) -= second * sum;
    }
    const int end = k + 3 < last ? k + 3 : last;
    double *row = row_of(a, first) + k;
    for (int i = first; i <= end; i++, row += a->stride) {
        double sum = row[0] + by.second * row[1];
        if (three) {
            sum += by.third * row[2];
            row[2] -= third * sum;
        }
        row[0] -= by.factor * sum;
        row[1] -= second * sum;
    }
}

/* Take a double-shift step on rows `first` to `last`. Return 0 if a vector is too short to be normalized. */
WITHIN int step(const Matrix *a, int first, int last, int vain)
{
    double shifts[4], v[3];
    find_shifts(a, first, last, vain, shifts);
    const int begin = find_begin(a, first, last, shifts, v);
    for (int k = begin; k < last; k++) {
        const int three = k + 2 <= last;
        if (k > begin)
            v[0] = entry(a, k, k - 1), v[1] = entry(a, k + 1, k - 1), v[2] = three ? entry(a, k + 2, k - 1) : 0.0;
        const Reflection by = reflection_of(v[0], v[1], v[2]);
        if (!(fabs(by.length) * fabs(by.length) >= VANISHING) && (v[1] != 0.0 || v[2] != 0.0))
            return 0;
        const double before = k > first ? entry(a, k, k - 1) : 0.0;
        reflect(a, first, last, k, three, by);
        if (k > begin) {
            row_of(a, k)[k - 1] = by.length;
            row_of(a, k + 1)[k - 1] = 0.0;
            if (three)
                row_of(a, k + 2)[k - 1] = 0.0;
        } else if (begin > first) {
            row_of(a, k)[k - 1] = before * (1.0 - by.factor); /* the second and third entries of the column are negligible */
            row_of(a, k + 1)[k - 1] = 0.0;
            row_of(a, k + 2)[k - 1] = 0.0;
        }
    }
    return 1;
}

/* Write the eigenvalues of a Hessenberg matrix (n, 2). Return 0 if the steps do not converge. */
WITHIN int deflate(const Matrix *a, double *values)
{
    int last = a->n - 1;
    for (int vain = 0, taken = 0; last >= 0;) {
        int first = last;
        while (first > 0 && !negligible(a, first))
            first--;
        if (first > 0)
            row_of(a, first)[first - 1] = 0.0;
        if (first < last - 1) {
            if (taken++ == STEPS * (a->n > 10 ? a->n : 10) || !step(a, first, last, vain++))
                return 0;
            continue;
        }
        if (first == last) {
            values[2 * last] = entry(a, last, last);
            values[2 * last + 1] = 0.0;
        } else {
            solve_pair(entry(a, first, first), entry(a, first, last), entry(a, last, first), entry(a, last, last),
                       values + 2 * first);
        }
        last = first - 1;
        vain = 0;
    }
    return 1;
}

/* Copy a matrix; return 0 unless its largest entry lies between the bounds. */
WITHIN int copy(const Matrix *a, const double *matrix)
{
    double largest = 0.0;
    int finite = 1;
    for (int i = 0; i < a->n; i++)
        for (int j = 0; j < a->stride; j++) {
            const double here = j < a->n ? matrix[i * a->n + j] : 0.0, size = fabs(here);
            row_of(a, i)[j] = here;
            largest = size > largest ? size : largest;
            finite &= size <= LARGEST; /* not NaN */
        }
    return finite && largest >= SMALLEST;
}

WITHIN int solve(int n, double *scratch, const double *matrix, double *values)
{
    const int stride = (n + LANES - 1) / LANES * LANES;
    const Matrix a = {n, stride, scratch};
    double *v = scratch + (ptrdiff_t)n * stride;
    if (!copy(&a, matrix))
        return 0;
    balance(&a);
    return reduce(&a, v, v + stride) && deflate(&a, values);
}

WIDE static int solve_one(int n, double *scratch, const double *matrix, double *values)
{
    if (n == 6) /* three and four coordinates: the compiler unrolls loops of known length */
        return solve(6, scratch, matrix, values);
    if (n == 8)
        return solve(8, scratch, matrix, values);
    return solve(n, scratch, matrix, values);
}

int find_eigenvalues(const Eigenproblems *wanted)
{
    const ptrdiff_t n = wanted->n, stride = (n + LANES - 1) / LANES * LANES;
    double *scratch = calloc((size_t)((n + 2) * stride) + 1, sizeof *scratch);
    for (ptrdiff_t at = 0; scratch && at < wanted->count; at++) {
        double *values = wanted->values + at * 2 * n;
        if (!solve_one(wanted->n, scratch, wanted->matrices + at * n * n, values))
            for (ptrdiff_t i = 0; i < 2 * n; i++)
                values[i] = NAN;
    }
    free(scratch);
    return scratch != NULL;
}
