"""What is not known of a line, carried through the analysis: samples, probabilities, and which assumption decides."""
