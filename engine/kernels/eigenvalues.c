/* Eigenvalues of small real matrices: balanced, brought to Hessenberg form by reflections, and found by double steps of
 * the QR method (J. G. F. Francis 1961; B. T. Smith et al., EISPACK, 1976, balanc and hqr). */
#include "kernels.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = 60, EXCEPTIONAL = 10 };

/* Scale rows and columns by powers of two until their sums of sizes are alike. */
WITHIN void balance(int n, double *a)
{
    for (int moved = 1; moved;) {
        moved = 0;
        for (int i = 0; i < n; i++) {
            double column = 0.0, row = 0.0, factor = 1.0;
            for (int j = 0; j < n; j++) {
                column += j == i ? 0.0 : fabs(a[j * n + i]);
                row += j == i ? 0.0 : fabs(a[i * n + j]);
            }
            const double sum = column + row;
            if (column == 0.0 || row == 0.0 || !isfinite(sum))
                continue;
            for (; column < 0.5 * row; column *= 4.0)
                factor *= 2.0;
            for (; column > 2.0 * row; column *= 0.25)
                factor *= 0.5;
            if ((column + row) / factor >= 0.95 * sum)
                continue;
            moved = 1;
            for (int j = 0; j < n; j++) {
                a[i * n + j] /= factor;
                a[j * n + i] *= factor;
            }
        }
    }
}

/* Reflect what stands below the subdiagonal of each column to zero, from both sides. */
WITHIN void reduce(int n, double *a, double *v)
{
    for (int k = 0; k + 2 < n; k++) {
        double square = 0.0;
        for (int i = k + 1; i < n; i++) {
            v[i] = a[i * n + k];
            square += v[i] * v[i];
        }
        const double size = copysign(sqrt(square), v[k + 1]);
        if (square == v[k + 1] * v[k + 1])
            continue;
        v[k + 1] += size;
        const double twice = 1.0 / (size * v[k + 1]);
        for (int j = k; j < n; j++) {
            double along = 0.0;
            for (int i = k + 1; i < n; i++)
                along += v[i] * a[i * n + j];
            for (int i = k + 1; i < n; i++)
                a[i * n + j] -= twice * along * v[i];
        }
        for (int i = 0; i < n; i++) {
            double along = 0.0;
            for (int j = k + 1; j < n; j++)
                along += a[i * n + j] * v[j];
            for (int j = k + 1; j < n; j++)
                a[i * n + j] -= twice * along * v[j];
        }
        for (int i = k + 2; i < n; i++)
            a[i * n + k] = 0.0;
    }
}

/* Both eigenvalues of the last two rows of a block that ends with row `last`, as real and imaginary parts. */
WITHIN void solve_pair(int n, const double *a, int last, double shift, double *values)
{
    const double x = a[last * n + last], y = a[(last - 1) * n + last - 1];
    const double w = a[last * n + last - 1] * a[(last - 1) * n + last];
    const double p = 0.5 * (y - x), q = p * p + w, z = sqrt(fabs(q));
    double *first = values + 2 * (last - 1), *second = values + 2 * last;
    if (q < 0.0) {
        first[0] = second[0] = x + shift + p;
        first[1] = z, second[1] = -z;
        return;
    }
    const double far = p + copysign(z, p);
    first[0] = x + shift + far;
    second[0] = x + shift - (far != 0.0 ? w / far : 0.0);
    first[1] = second[1] = 0.0;
}

/* Where a subdiagonal entry is negligible, from row `last` upwards. */
WITHIN int first_of_block(int n, double *a, int last, double norm)
{
    for (int l = last; l > 0; l--) {
        const double around = fabs(a[(l - 1) * n + l - 1]) + fabs(a[l * n + l]), size = around == 0.0 ? norm : around;
        if (fabs(a[l * n + l - 1]) + size == size) {
            a[l * n + l - 1] = 0.0;
            return l;
        }
    }
    return 0;
}

/* The sum x + y and product of the shifts are those of the last two rows; set the first column p of the double step and
 * return the row where it may begin. */
WITHIN int begin_step(int n, const double *a, int first, int last, double x, double y, double w, double *p)
{
    for (int m = last - 2;; m--) {
        const double z = a[m * n + m], r = x - z, s = y - z;
        p[0] = (r * s - w) / a[(m + 1) * n + m] + a[m * n + m + 1];
        p[1] = a[(m + 1) * n + m + 1] - z - r - s;
        p[2] = a[(m + 2) * n + m + 1];
        const double size = fabs(p[0]) + fabs(p[1]) + fabs(p[2]);
        for (int i = 0; i < 3; i++)
            p[i] /= size;
        if (m == first)
            return m;
        const double left = fabs(a[m * n + m - 1]) * (fabs(p[1]) + fabs(p[2]));
        const double near = fabs(a[(m - 1) * n + m - 1]) + fabs(z) + fabs(a[(m + 1) * n + m + 1]);
        if (left + fabs(p[0]) * near == fabs(p[0]) * near)
            return m;
    }
}

/* Reflect rows and columns k, k + 1 and, but for the last step, k + 2 of the block by 1 - (x, y, z) (1, q, r). */
WITHIN void reflect(int n, double *a, const int *block, int k, const double *p, double s)
{
    const int first = block[0], last = block[1], three = k < last - 1, end = k + 3 < last ? k + 3 : last;
    const double head = p[0] + s, x = head / s, y = p[1] / s, z = p[2] / s, q = p[1] / head, r = p[2] / head;
    double *top = a + k * n, *middle = top + n, *bottom = middle + (three ? n : 0);
    for (int j = k; j <= last; j++) {
        const double sum = top[j] + q * middle[j] + (three ? r * bottom[j] : 0.0);
        if (three)
            bottom[j] -= sum * z;
        middle[j] -= sum * y;
        top[j] -= sum * x;
    }
    for (int i = first; i <= end; i++) {
        double *row = a + i * n + k;
        const double sum = x * row[0] + y * row[1] + (three ? z * row[2] : 0.0);
        if (three)
            row[2] -= sum * r;
        row[1] -= sum * q;
        row[0] -= sum;
    }
}

/* Take a double step on the block of rows first to last, with shifts of sum x + y and product x y - w. */
WITHIN void step(int n, double *a, int first, int last, double x, double y, double w)
{
    double p[3];
    const int block[] = {first, last}, begin = begin_step(n, a, first, last, x, y, w, p);
    for (int i = begin + 2; i <= last; i++) {
        a[i * n + i - 2] = 0.0;
        if (i > begin + 2)
            a[i * n + i - 3] = 0.0;
    }
    for (int k = begin; k < last; k++) {
        double size = 1.0;
        if (k > begin) {
            for (int i = 0; i < 3; i++)
                p[i] = k + i <= last ? a[(k + i) * n + k - 1] : 0.0;
            size = fabs(p[0]) + fabs(p[1]) + fabs(p[2]);
            for (int i = 0; i < 3 && size != 0.0; i++)
                p[i] /= size;
        }
        const double s = copysign(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), p[0]);
        if (s == 0.0)
            continue;
        if (k > begin)
            a[k * n + k - 1] = -s * size;
        else if (first < begin)
            a[k * n + k - 1] = -a[k * n + k - 1];
        if (k == last - 1)
            p[2] = 0.0;
        reflect(n, a, block, k, p, s);
    }
}

/* Deflate one or two eigenvalues after another; return how many are left when the steps do not end. */
WITHIN int deflate(int n, double *a, double *values)
{
    double norm = 0.0, shift = 0.0;
    for (int e = 0; e < n * n; e++)
        norm += fabs(a[e]);
    int last = n - 1;
    for (int steps = 0; last >= 0 && steps < MOST_STEPS; steps++) {
        const int first = first_of_block(n, a, last, norm);
        const double corner = a[last * n + last];
        if (first == last) {
            values[2 * last] = corner + shift, values[2 * last + 1] = 0.0;
            last -= 1, steps = -1;
        } else if (first == last - 1) {
            solve_pair(n, a, last, shift, values);
            last -= 2, steps = -1;
        } else if (steps % EXCEPTIONAL == EXCEPTIONAL - 1) {
            shift += corner;
            for (int i = 0; i <= last; i++)
                a[i * n + i] -= corner;
            const double s = fabs(a[last * n + last - 1]) + fabs(a[(last - 1) * n + last - 2]);
            step(n, a, first, last, 0.75 * s, 0.75 * s, -0.4375 * s * s);
        } else
            step(n, a, first, last, corner, a[(last - 1) * n + last - 1],
                 a[last * n + last - 1] * a[(last - 1) * n + last]);
    }
    return last + 1;
}

WITHIN int solve_one(int n, const double *matrix, double *work, double *values)
{
    double *a = work, *v = work + n * n;
    memcpy(a, matrix, (size_t)n * (size_t)n * sizeof *a);
    for (int e = 0; e < n * n; e++)
        if (!isfinite(a[e]))
            return n;
    balance(n, a);
    reduce(n, a, v);
    return deflate(n, a, values);
}

WIDE void find_eigenvalues(ptrdiff_t count, int n, const double *matrices, double *work, double *values)
{
    for (ptrdiff_t i = 0; i < count; i++) {
        double *own = values + 2 * i * n;
        const double *matrix = matrices + i * n * n;
        const int left = n == 6 ? solve_one(6, matrix, work, own) : solve_one(n, matrix, work, own);
        for (int k = 0; left && k < 2 * n; k++)
            own[k] = NAN;
    }
}
