"""What several pictures read from rows and draw alike: motions, branches, and what surrounds a cross-section."""
