"""Newton's method, continuation and polynomials: mathematics without any knowledge of lines."""
