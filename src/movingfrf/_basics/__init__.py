"""What every room uses and no user sees: checks, arrays, words, files of numbers."""
