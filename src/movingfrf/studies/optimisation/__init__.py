"""The best values of keys of a scenario, within limits."""
