"""What takes many solutions: the comparison of methods and the paper."""
