/* The load: cubic polynomials in linear forms of (q, q'/U), summed over points. force and force_gradient of
 * engine/models/aerodynamic_load.py, theory section 5. */
#include "monomials.h"

#include <string.h>

Model model_of(const Model *stack, ptrdiff_t member)
{
    Model one = *stack;
    const ptrdiff_t m = one.m, points = one.points, local = one.local;
    one.mass += member * m * m;
    one.damping += member * m * m;
    one.stiffness += member * m * m;
    one.forms += member * points * local * 2 * m;
    one.table += member * points * m * one.monomials;
    one.slopes += member * points * m * local * one.lower;
    return one;
}

size_t load_scratch(const Model *model)
{
    return (size_t)model->local + 1 + (size_t)model->monomials;
}

WITHIN Lanes polynomial(int count, const double *coefficients, const Lanes *terms)
{
    Lanes sum = {0};
    for (int t = 0; t < count; t++)
        sum += coefficients[t] * terms[t];
    return sum;
}

WITHIN void evaluate(const Model *model, int m, int local, const Lanes *state, Lanes *force, Lanes *gradient,
                     Lanes *scratch)
{
    const int lower = 1 + local + local * (local + 1) / 2;
    const int monomials = lower - 1 + local * (local + 1) * (local + 2) / 6;
    Lanes *x = scratch, *terms = scratch + local;
    memset(force, 0, (size_t)m * sizeof *force);
    memset(gradient, 0, (size_t)m * 2 * (size_t)m * sizeof *gradient);
    for (int p = 0; p < model->points; p++) {
        const double *forms = model->forms + (ptrdiff_t)p * local * 2 * m;
        for (int l = 0; l < local; l++)
            x[l] = polynomial(2 * m, forms + l * 2 * m, state);
        powers(local, x, terms);
        for (int i = 0; i < m; i++) {
            const ptrdiff_t row = (ptrdiff_t)p * m + i;
            force[i] += polynomial(monomials, model->table + row * monomials, terms + 1);
            for (int l = 0; l < local; l++) {
                const Lanes slope = polynomial(lower, model->slopes + (row * local + l) * lower, terms);
                for (int v = 0; v < 2 * m; v++)
                    if (forms[l * 2 * m + v] != 0.0)
                        gradient[i * 2 * m + v] += forms[l * 2 * m + v] * slope;
            }
        }
    }
}

WIDE void load_at(const Model *model, const Lanes *state, Lanes *force, Lanes *gradient, Lanes *scratch)
{
    if (model->m == 3 && model->local == 3) /* the hybrid model: the compiler unrolls loops of known length */
        evaluate(model, 3, 3, state, force, gradient, scratch);
    else
        evaluate(model, model->m, model->local, state, force, gradient, scratch);
}
