"""One case by several methods: times, memory, errors, and ratios at equal error."""
