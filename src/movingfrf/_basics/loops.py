"""How loops are compiled, by numba (the extra `fast`): once per machine, kept in a cache beside their source.

Numba compiles afresh where the source of a function has changed, not where this file has: who changes it clears
the caches. Loops hold no lock: others compute at the same time.
"""

from __future__ import annotations

from numba import njit

# The compiler may take −0 for 0 and change nothing else: what it makes and what lies in the cache give the same
# numbers. Division by zero gives infinity, as in NumPy.
loop = njit(cache=True, error_model="numpy", fastmath={"nsz"}, nogil=True)
