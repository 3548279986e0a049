/* The forces of wind and stretching: cubic polynomials in linear forms of (q, q'/U), summed over points, and in q.
 * resultant and resultant_gradient of engine/models/reduced_model.py, theory sections 5 and 12.1. */
#include "monomials.h"

#include <math.h>
#include <string.h>

Model model_of(const Model *stack, ptrdiff_t member)
{
    Model one = *stack;
    const ptrdiff_t m = one.m, points = one.points, local = one.local;
    const ptrdiff_t table = points * m * monomials_of(one.local), slopes = points * m * local * lower_of(one.local);
    one.parity += member * m;
    one.mass += member * m * m;
    one.damping += member * m * m;
    one.stiffness += member * m * m;
    if (one.samples) {
        one.unexpanded = unexpanded_of(&stack->unexpanded, one.m, member);
    } else {
        one.forms += member * points * local * 2 * m;
        one.table += member * table;
        one.slopes += member * slopes;
    }
    if (one.stretches) {
        one.restoring += member * m * monomials_of(one.m);
        one.restoring_slopes += member * m * m * lower_of(one.m);
    }
    return one;
}

int alternates(const Model *model, int harmonics, const double *coefficients, double share, const double *scale)
{
    const int size = 2 * harmonics + 1;
    int odd = 0;
    for (int j = 0; j < model->m; j++) {
        if (!model->parity[j])
            return 0;
        odd |= model->parity[j] < 0;
        for (int c = 0; c < size; c++)
            if ((c + 1) / 2 % 2 != (model->parity[j] < 0)
                && !(fabs(coefficients[j * size + c]) <= (share ? share * scale[j * size + c] : 0.0)))
                return 0;
    }
    return odd && harmonics && model->samples % 2 == 0;
}

size_t load_scratch(const Model *model)
{
    const int most = model->stretches && model->m > model->local ? model->m : model->local;
    return (size_t)(model->local + model->m + model->m * most) + 1 + (size_t)monomials_of(most);
}

/* Sum the products of rows of coefficients (rows, terms) with the same terms, three rows at a time: the sum of one row
 * waits for every addition. */
WITHIN void sum_rows(int rows, int count, const double *coefficients, const Lanes *terms, Lanes *sums)
{
    int row = 0;
    for (; row + 2 < rows; row += 3, coefficients += 3 * count) {
        Lanes first = {0}, second = {0}, third = {0};
        for (int t = 0; t < count; t++) {
            first += coefficients[t] * terms[t];
            second += coefficients[count + t] * terms[t];
            third += coefficients[2 * count + t] * terms[t];
        }
        sums[row] = first, sums[row + 1] = second, sums[row + 2] = third;
    }
    for (; row < rows; row++, coefficients += count) {
        Lanes sum = {0};
        for (int t = 0; t < count; t++)
            sum += coefficients[t] * terms[t];
        sums[row] = sum;
    }
}

WITHIN void add_wind(const Model *model, int m, int local, const Lanes *state, Lanes *force, Lanes *gradient,
                     Lanes *scratch)
{
    const int lower = lower_of(local), monomials = monomials_of(local);
    Lanes *x = scratch, *own = x + local, *slopes = own + m, *terms = slopes + m * local;
    for (int p = 0; p < model->points; p++) {
        const double *forms = model->forms + (ptrdiff_t)p * local * 2 * m;
        sum_rows(local, 2 * m, forms, state, x);
        powers(local, x, terms);
        sum_rows(m, monomials, model->table + (ptrdiff_t)p * m * monomials, terms + 1, own);
        sum_rows(m * local, lower, model->slopes + (ptrdiff_t)p * m * local * lower, terms, slopes);
        for (int i = 0; i < m; i++) {
            force[i] += own[i];
            for (int l = 0; l < local; l++)
                for (int v = 0; v < 2 * m; v++)
                    if (forms[l * 2 * m + v] != 0.0)
                        gradient[i * 2 * m + v] += forms[l * 2 * m + v] * slopes[i * local + l];
        }
    }
}

WITHIN void subtract_stretching(const Model *model, int m, double share, const Lanes *state, Lanes *force,
                                Lanes *gradient, Lanes *restoring, Lanes *scratch)
{
    Lanes *slopes = scratch, *terms = scratch + m * m;
    powers(m, state, terms);
    sum_rows(m, monomials_of(m), model->restoring, terms + 1, restoring);
    sum_rows(m * m, lower_of(m), model->restoring_slopes, terms, slopes);
    for (int i = 0; i < m; i++) {
        restoring[i] *= share;
        force[i] -= restoring[i];
        for (int j = 0; j < m; j++)
            gradient[i * 2 * m + j] -= share * slopes[i * m + j];
    }
}

WIDE void load_at(const Model *model, double speed, const Lanes *state, Lanes *force, Lanes *gradient, Lanes *restoring,
                  Lanes *scratch)
{
    const int m = model->m;
    memset(force, 0, (size_t)m * sizeof *force);
    memset(gradient, 0, (size_t)m * 2 * (size_t)m * sizeof *gradient);
    if (model->samples)
        unexpanded_at(&model->unexpanded, m, state, force, gradient);
    else if (m == 3 && model->local == 3) /* the hybrid model: the compiler unrolls loops of known length */
        add_wind(model, 3, 3, state, force, gradient, scratch);
    else if (m == 3 && model->local == 4)
        add_wind(model, 3, 4, state, force, gradient, scratch);
    else if (m == 4 && model->local == 4)
        add_wind(model, 4, 4, state, force, gradient, scratch);
    else
        add_wind(model, m, model->local, state, force, gradient, scratch);
    if (!model->stretches)
        memset(restoring, 0, (size_t)m * sizeof *restoring);
    else if (m == 3)
        subtract_stretching(model, 3, 1.0 / (speed * speed), state, force, gradient, restoring, scratch);
    else if (m == 4)
        subtract_stretching(model, 4, 1.0 / (speed * speed), state, force, gradient, restoring, scratch);
    else
        subtract_stretching(model, m, 1.0 / (speed * speed), state, force, gradient, restoring, scratch);
}
