/* Compiled forms of the engine's innermost loops. The numpy forms beside their callers are their tests and stand in for
 * them where no compiler was at hand. Every array is in C order and of double precision. */
#ifndef GALLOPING_KERNELS_H
#define GALLOPING_KERNELS_H

#include <stddef.h>

/* Four states, samples or steps side by side: arithmetic on one of these is arithmetic on all. */
#define LANES 4
typedef double Lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

/* Versions of a function, of which the loader takes the one that the processor has the instructions for. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
#define WIDE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDE
#endif

/* Part of a function with such versions: by itself it would have the instructions of any processor. */
#ifdef __GNUC__
#define WITHIN static inline __attribute__((always_inline))
#else
#define WITHIN static inline
#endif

/* One reduced model, M q'' + C q' + K q = U^2 f(q, q'/U), laid out as engine.models.reduced_model.ReducedModel:
 * mass, damping, stiffness (m, m); forms (points, local, 2 m); table (points, m, monomials);
 * slopes (points, m, local, lower monomials). */
typedef struct {
    int m, points, local, monomials, lower;
    const double *mass, *damping, *stiffness, *forms, *table, *slopes;
} Model;

/* Shift a stack of models to one of its members. */
Model model_of(const Model *stack, ptrdiff_t member);

/* Lanes of scratch that load_at needs. */
size_t load_scratch(const Model *model);

/* Evaluate f (m) and its gradient by (q, q'/U), (m, 2 m), at LANES states (2 m). Theory section 5. */
void load_at(const Model *model, const Lanes *state, Lanes *force, Lanes *gradient, Lanes *scratch);

/* Solve systems by elimination with partial pivoting. Row i holds the coefficients, its right sides from entry n on, and
 * then at least LANES zeros, which are lost; the solutions are x (sides, n), and sizes (n + LANES) is scratch. Return 0
 * if a pivot vanishes. Zero multipliers are skipped, so columns that are nearly empty belong first. */
int eliminate(int n, double **rows, int sides, double *sizes, double *x);

/* What Newton's method is told, engine.numerics.newton.Options. */
typedef struct {
    double tolerance, largest_step;
    int iterations;
} Options;

/* Starts and results of the harmonic balance. With n = m (2 H + 1) the unknowns x (cycles, unknowns) are the coefficients
 * and w, n + 1 in all, at wind_speed (cycles); or the wind speed is one more unknown, `follows` is set, and the condition
 * row . x = target, (cycles, unknowns) and (cycles), is one more equation. The phase is fixed by
 * reference . (x - anchor) = 0, (cycles, n) and (cycles, unknowns). scale is of x; step, iterations (cycles); tangent
 * (cycles, unknowns) is the direction in which row . x alone grows. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics, follows;
    const ptrdiff_t *member;
    const double *wind_speed, *reference, *anchor, *scale, *row, *target;
    double *x, *step, *tangent;
    ptrdiff_t *iterations;
} Balances;

/* Solve every balance by Newton's method; return 0 if memory is short. Theory section 7.2. */
int solve_balances(const Model *stack, const Balances *balances, const Options *options);

/* Orbits whose balance is wanted: coefficients (cycles, m, 2 H + 1); angular_frequency, wind_speed (cycles); with
 * n = m (2 H + 1), residuals (cycles, n) and slopes (cycles, n, n + 2), by the coefficients, w and U. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics;
    const ptrdiff_t *member;
    const double *coefficients, *angular_frequency, *wind_speed;
    double *residuals, *slopes;
} Linearizations;

/* Evaluate every balance and its slopes; return 0 if memory is short. */
int linearize_balances(const Model *stack, const Linearizations *wanted);

/* Orbits whose monodromy is wanted: member (cycles); inverse_mass (members, m, m); coefficients
 * (cycles, m, 2 H + 1); angular_frequency, wind_speed, steps, first (cycles); values, slopes (rows, 2 H + 1), the basis and its derivative by
 * tau, for each cycle from row `first` on at the first and then at the second Gauss points of its steps, a multiple of
 * LANES; matrices (cycles, 2 m, 2 m), NaN where there are no steps. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics;
    const ptrdiff_t *member, *steps, *first;
    const double *inverse_mass, *coefficients, *angular_frequency, *wind_speed, *values, *slopes;
    double *matrices;
} Monodromies;

/* Integrate the linearized equations over one period; return 0 if memory is short. Theory section 7.3. */
int integrate_monodromies(const Model *stack, const Monodromies *wanted);

/* Starts whose motions are integrated directly, laid out as engine.checks.settled_motion.Flow with the starts on the last axis:
 * half (2 m, 2 m), bend (points, m, monomials of degree 2 and 3), forms (points, local, 2 m), angle (2 m) and step of each.
 * One step is taken for every entry of window (steps), which weighs the squares that are summed up. state (2 m) is moved
 * on; square (2 m) and largest, the largest square of the angle of attack, are of the states after each step. */
typedef struct {
    ptrdiff_t starts, steps;
    int m, points, local;
    const double *half, *bend, *forms, *step, *angle, *window;
    double *state, *square, *largest;
} Flows;

/* Integrate all starts; return 0 if memory is short. */
int integrate_flows(const Flows *flows);

/* Where the explicit first harmonic is wanted: polynomials (members, 4, 7) and statics (members, 3) as in
 * engine.cycles.first_harmonic; member, angle (count); even, square (count, 2). */
typedef struct {
    ptrdiff_t count;
    const ptrdiff_t *member;
    const double *polynomials, *statics, *angle;
    double *even, *square;
} EvenParts;

/* Evaluate the even part of the characteristic polynomial at the roots w^2 of its odd part. Theory section 7.1. */
void evaluate_even_parts(const EvenParts *wanted);

#endif
