"""Scenario files: what a user wrote, read, checked and said in words."""
