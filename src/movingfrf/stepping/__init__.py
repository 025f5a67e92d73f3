"""The slow, independent ways to the same answers: finite guideways stepped in time, and Duhamel's integral."""
