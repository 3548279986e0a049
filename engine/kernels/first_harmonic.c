/* The scalar equation of the explicit first harmonic: _mean_angle, _gains and _even_part of
 * engine/cycles/first_harmonic.py. Theory section 7.1. */
#include "kernels.h"

#include <math.h>

enum { NEWTON_STEPS = 6, DEGREE = 6 };

/* Solve for the mean angle alpha_0 under an oscillation of amplitude R, by Newton's method from zero. */
static double mean_angle(const double *g, double angle)
{
    const double half = 0.5 * angle * angle;
    double alpha = 0.0;
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const double square = alpha * alpha;
        const double value = g[0] * alpha + g[1] * (square + half) + g[2] * alpha * (square + 3.0 * half) - alpha;
        const double slope = g[0] + 2.0 * g[1] * alpha + 3.0 * g[2] * (square + half) - 1.0;
        const double step = slope == 0.0 ? 0.0 : value / slope;
        alpha -= fmin(fmax(step, -0.5), 0.5);
        if (fabs(step) < 1e-15)
            break;
    }
    return alpha;
}

/* Set the even part at one root w^2 of the odd part, and that root; NaN if the root is not positive. */
static void at_root(const double *p, double root, double *even, double *square)
{
    *square = root > 0.0 ? root : NAN;
    *even = p[0] - *square * (p[2] - *square * (p[4] - *square * p[6]));
}

void evaluate_even_parts(const EvenParts *wanted)
{
    for (ptrdiff_t i = 0; i < wanted->count; i++) {
        const double *polynomials = wanted->polynomials + wanted->member[i] * 4 * (DEGREE + 1), angle = wanted->angle[i];
        const double alpha = mean_angle(wanted->statics + wanted->member[i] * 3, angle);
        const double gains[] = {1.0, 2.0 * alpha, 3.0 * alpha * alpha + 0.75 * angle * angle};
        double p[DEGREE + 1];
        for (int k = 0; k <= DEGREE; k++) {
            p[k] = polynomials[k];
            for (int j = 0; j < 3; j++)
                p[k] -= gains[j] * polynomials[(j + 1) * (DEGREE + 1) + k];
        }
        const double far = p[3] + copysign(sqrt(p[3] * p[3] - 4.0 * p[5] * p[1]), p[3]); /* NaN if there is no real root */
        at_root(p, 2.0 * p[1] / far, wanted->even + 2 * i, wanted->square + 2 * i);
        at_root(p, far / (2.0 * p[5]), wanted->even + 2 * i + 1, wanted->square + 2 * i + 1);
    }
}
