"""Where guideway and vehicle meet, in the frequency domain."""
