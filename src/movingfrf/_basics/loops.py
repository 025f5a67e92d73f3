"""How loops are compiled, by numba (the extra `fast`): once per machine, kept in a cache beside their source."""

from __future__ import annotations

from numba import njit

# The compiler may round a product and a sum once instead of twice, and change nothing else that changes results.
# Division by zero gives infinity, as in NumPy.
loop = njit(cache=True, error_model="numpy", fastmath={"contract", "nsz"})
