"""Results: what they are called, what is to be known about them, and how they lie on disk."""
