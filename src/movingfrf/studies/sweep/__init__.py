"""Many cases: what of a scenario varies, its cases, their measures, and where these are kept."""
