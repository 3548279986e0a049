"""Tables that set motions beside others: of another model, among other loops, or of the line without its devices."""
