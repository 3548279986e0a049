"""Several spans that move together: their freedoms side by side, what joins them, and the modes. No wind, no solver."""
