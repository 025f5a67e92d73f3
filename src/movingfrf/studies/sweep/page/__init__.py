"""The page of a sweep: questions, their answers in numbers, and the figures that show them."""
