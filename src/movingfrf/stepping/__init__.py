"""The slow, independent ways to the same answers: finite roads stepped in time, and Duhamel's integral."""
