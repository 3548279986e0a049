/* Compiled forms of the engine's innermost loops. The callers keep numpy forms, which run where the kernels were not built
 * and against which the kernels are tested. Every array is in C order; reals are double precision. */
#ifndef GALLOPING_KERNELS_H
#define GALLOPING_KERNELS_H

#include <stddef.h>

/* Four states, samples or steps side by side: arithmetic on one of these is arithmetic on all. */
#define LANES 4
typedef double Lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

/* Compile a function once per instruction set; the loader picks the version that suits the processor. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDE
#endif

/* Inline a helper into such a function; compiled on its own, it would use only the instructions of the oldest processor. */
#ifdef __GNUC__
#define WITHIN static inline __attribute__((always_inline))
#else
#define WITHIN static inline
#endif

/* The numbers of monomials of `variables` variables of degree 1 to 3, and of degree 0 to 2. */
static inline int lower_of(int variables) { return 1 + variables + variables * (variables + 1) / 2; }
static inline int monomials_of(int variables)
{
    return lower_of(variables) - 1 + variables * (variables + 1) * (variables + 2) / 6;
}

/* The load of the relative wind as it stands, laid out as engine.models.unexpanded_load.UnexpandedLoad: fields (points, 3,
 * m), strength, factor, rest_angle, which (points), diameter, positions (points, subconductors, 2), present (subconductors)
 * and at_rest (m) of a member; curves of all members: first (curves + 1), the pieces of each, periodic, turning, origin,
 * density (curves), begins, knots (pieces) and powers (pieces, 3, 4). */
typedef struct {
    ptrdiff_t points, subconductors;
    const double *fields, *strength, *factor, *diameter, *positions, *present, *rest_angle, *at_rest;
    const double *origin, *density, *begins, *knots, *powers;
    const ptrdiff_t *which, *first, *periodic, *turning;
} Unexpanded;

/* One reduced model, M q'' + C q' + K q = U^2 f(q, q'/U) - g(q), laid out as engine.models.reduced_model.ReducedModel:
 * mass, damping, stiffness (m, m); f: forms (points, local, 2 m), table (points, m, monomials), slopes (points, m, local,
 * lower monomials); g, if it `stretches`: restoring (m, monomials of m variables) and restoring_slopes (m, m, lower
 * monomials). If there are `samples`, f is unexpanded, and a period of the harmonic balance has that many samples.
 * parity (m): 1 for even and -1 for odd coordinates of a model that is its own mirror image, 0 for others. */
typedef struct {
    int m, points, local, stretches, samples;
    const ptrdiff_t *parity;
    const double *mass, *damping, *stiffness, *forms, *table, *slopes, *restoring, *restoring_slopes;
    Unexpanded unexpanded;
} Model;

/* Return one member of a stack of unexpanded loads with m coordinates. */
Unexpanded unexpanded_of(const Unexpanded *stack, int m, ptrdiff_t member);

/* Evaluate an unexpanded load (m) at LANES states (2 m). */
void unexpanded_force(const Unexpanded *load, int m, const Lanes *state, Lanes *force);

/* Evaluate an unexpanded load (m) and its gradient by (q, q'/U), (m, 2 m), at LANES states (2 m). */
void unexpanded_at(const Unexpanded *load, int m, const Lanes *state, Lanes *force, Lanes *gradient);

/* Return one member of a stack of models. */
Model model_of(const Model *stack, ptrdiff_t member);

/* Return whether coefficients (m, 2 H + 1) are those of a cycle that alternates: half a period later it is its own mirror
 * image, so even coordinates have harmonics of even order only and odd ones of odd order. All others are at most a share of
 * their scale, of the same shape; a share of 0 needs no scale. */
int alternates(const Model *model, int harmonics, const double *coefficients, double share, const double *scale);

/* Return the number of Lanes of scratch that load_at needs. */
size_t load_scratch(const Model *model);

/* Evaluate f - g/U^2 (m), its gradient by (q, q'/U), (m, 2 m), and g/U^2 (m) at LANES states (2 m) and a wind speed U:
 * resultant and resultant_gradient of engine/models/reduced_model.py. Theory sections 5 and 12.1. */
void load_at(const Model *model, double speed, const Lanes *state, Lanes *force, Lanes *gradient, Lanes *restoring,
             Lanes *scratch);

/* Solve a linear system for several right sides by elimination with partial pivoting. Row i holds n coefficients, then its
 * right sides, then at least LANES zeros, which are overwritten. x (sides, n) receives the solutions; sizes (n + LANES) is
 * scratch. Return 0 if a pivot vanishes. Zero multipliers are skipped, so nearly empty columns should come first. */
int eliminate(int n, double **rows, int sides, double *sizes, double *x);

/* Options of Newton's method, as in engine.numerics.newton.NewtonOptions. */
typedef struct {
    double tolerance, largest_step;
    int iterations;
} Options;

/* Starts and results of the harmonic balance. The unknowns x (cycles, unknowns) are the n = m (2 H + 1) coefficients
 * and w at a given wind_speed (cycles). If `follows` is set, the wind speed is one more unknown and row . x = target,
 * (cycles, unknowns) and (cycles), is one more equation. reference . (x - anchor) = 0, (cycles, n) and (cycles,
 * unknowns), fixes the phase. scale (cycles, unknowns) is the size of x; a cycle whose first step is longer than reach
 * (cycles) is given up; step, iterations (cycles) are the last step's size and the number of steps, 0 at first;
 * residual (cycles, n) is that of the start, set by the first step; along tangent (cycles, unknowns) row . x grows by
 * one and the other residuals do not change. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics, follows;
    const ptrdiff_t *member;
    const double *wind_speed, *reference, *anchor, *scale, *row, *target, *reach;
    double *x, *step, *residual, *tangent;
    ptrdiff_t *iterations;
} Balances;

/* Solve every balance by Newton's method; return 0 if memory is short. engine/cycles/harmonic_balance.py, balance; theory
 * section 7.2. */
int solve_balances(const Model *stack, const Balances *balances, const Options *options);

/* Arguments and results of linearize_balances: coefficients (cycles, m, 2 H + 1); angular_frequency, wind_speed (cycles);
 * with n = m (2 H + 1), residuals (cycles, n) and slopes (cycles, n, n + 2) by the coefficients, w and U. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics;
    const ptrdiff_t *member;
    const double *coefficients, *angular_frequency, *wind_speed;
    double *residuals, *slopes;
} Linearizations;

/* Evaluate every balance and its slopes; return 0 if memory is short. engine/cycles/harmonic_balance.py, linearized. */
int linearize_balances(const Model *stack, const Linearizations *wanted);

/* Arguments and results of integrate_monodromies: member (cycles); inverse_mass (members, m, m); coefficients
 * (cycles, m, 2 H + 1); angular_frequency, wind_speed, steps, first (cycles). steps is a multiple of LANES. values, slopes
 * (rows, 2 H + 1): the Fourier basis and its derivative by tau; those of a cycle start at row `first`, at the first Gauss
 * points of all its steps and then at the second ones. matrices (cycles, 2 m, 2 m): NaN where there are no steps. */
typedef struct {
    ptrdiff_t cycles;
    int harmonics;
    const ptrdiff_t *member, *steps, *first;
    const double *inverse_mass, *coefficients, *angular_frequency, *wind_speed, *values, *slopes;
    double *matrices;
} Monodromies;

/* Integrate the linearized equations over one period; return 0 if memory is short. engine/cycles/floquet.py, monodromy;
 * theory section 7.3. */
int integrate_monodromies(const Model *stack, const Monodromies *wanted);

/* Arguments and results of find_eigenvalues: finite matrices (count, n, n); values (count, n, 2), real and imaginary parts,
 * NaN where the method fails. */
typedef struct {
    ptrdiff_t count;
    int n;
    const double *matrices;
    double *values;
} Eigenproblems;

/* Find the eigenvalues of every matrix, in no particular order; return 0 if memory is short. */
int find_eigenvalues(const Eigenproblems *wanted);

/* Arguments and results of integrate_flows, laid out as engine.checks.settled_motion.LawsonEquations with the starts on the
 * last axis: half_step (2 m, 2 m), nonlinear (points, rows, monomials of degree 2 and 3), outward (points, m, rows), forms
 * (points, local, 2 m), restoring (m, monomials of degree 2 and 3 of q) if it `stretches`, step and angle (2 m). One step is taken for every
 * entry of window (steps). state (2 m) is advanced in place; square (2 m) receives the sum of the squares after each step,
 * weighted by the window, and largest the largest square of the angle of attack. An unexpanded load has no points here: if
 * there is `gain` (m, m), its part of q'' is gain f(q, q'/U) - linear (q, q'), with linear (m, 2 m); member, wind_speed
 * (starts). */
typedef struct {
    ptrdiff_t starts, steps;
    int m, points, rows, local, stretches;
    const double *half_step, *nonlinear, *outward, *forms, *restoring, *step, *angle, *gain, *linear, *wind_speed, *window;
    const ptrdiff_t *member;
    Unexpanded unexpanded;
    double *state, *square, *largest;
} Flows;

/* Integrate all starts; return 0 if memory is short. engine/checks/settled_motion.py, _block. */
int integrate_flows(const Flows *flows);

/* Arguments and results of find_reaches, laid out as engine.models.relative_wind.NodalMotion: forms (members, nodes, 4,
 * 2 m), arms (members, nodes, subconductors, 2), diameter (members); member (motions), state (motions, 2 m, samples),
 * finite; reach (2, motions). Where `published`, only the vertical velocity turns the wind. */
typedef struct {
    ptrdiff_t motions, samples, nodes, subconductors;
    int m, published;
    const double *forms, *arms, *diameter, *state;
    const ptrdiff_t *member;
    double *reach;
} Reaches;

/* Find the largest angle of attack and velocity ratio of each motion; return 0 if memory is short. */
int find_reaches(const Reaches *wanted);

/* Arguments and results of evaluate_even_parts: polynomials (members, 4, 7) and statics (members, 3) as in _ScalarEquation
 * of engine/cycles/first_harmonic.py; member, angle (count); even, square (count, 2). */
typedef struct {
    ptrdiff_t count;
    const ptrdiff_t *member;
    const double *polynomials, *statics, *angle;
    double *even, *square;
} EvenParts;

/* Evaluate the even part of the characteristic polynomial at the roots w^2 of its odd part, as _even_part of
 * engine/cycles/first_harmonic.py does. Theory section 7.1. */
void evaluate_even_parts(const EvenParts *wanted);

#endif
