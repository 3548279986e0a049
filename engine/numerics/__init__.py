"""Newton's method, continuation and polynomials: mathematics that knows nothing of lines."""
