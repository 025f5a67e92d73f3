"""The command `movingfrf`."""
