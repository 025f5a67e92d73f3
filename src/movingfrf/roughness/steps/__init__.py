"""What is done to a measured profile before it is used: a step a file."""
