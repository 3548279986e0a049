/* The monomials of a cubic polynomial, in the order of monomials and powers in engine/numerics/polynomial.py. */
#ifndef GALLOPING_MONOMIALS_H
#define GALLOPING_MONOMIALS_H

#include "kernels.h"

/* Evaluate 1 and every monomial, x_i, then x_i x_j (i <= j), then x_i x_j x_k (i <= j <= k). */
WITHIN void powers(int variables, const Lanes *x, Lanes *terms)
{
    Lanes *next = terms;
    *next++ = (Lanes){0} + 1.0;
    for (int i = 0; i < variables; i++)
        *next++ = x[i];
    for (int i = 0; i < variables; i++)
        for (int j = i; j < variables; j++)
            *next++ = x[i] * x[j];
    for (int i = 0; i < variables; i++)
        for (int j = i; j < variables; j++) {
            const Lanes product = x[i] * x[j];
            for (int k = j; k < variables; k++)
                *next++ = product * x[k];
        }
}

#endif
