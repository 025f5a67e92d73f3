"""From results to pages: curves, figures, tables and the one file they are put into."""
