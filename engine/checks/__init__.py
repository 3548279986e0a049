"""What tests limit cycles from outside the harmonic balance: direct integration, measures of confidence."""
