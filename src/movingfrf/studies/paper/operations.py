"""How many real multiplications each way to a road's deflection under moving loads takes.

A division counts as a multiplication, an addition or a change of sign as nothing. Every product that is written
down counts, also one by a number that happens to be 0 or 1. What is prepared once does not count: factors of
matrices, weights of an integral, the moving FRF itself, sines and cosines of a transform.
"""

from __future__ import annotations

from movingfrf._basics.checks import checking
from movingfrf.stepping.marching import STRIDE


def newmark_full(dofs: int, steps: int) -> int:
    """Count for Newmark's method with full matrices, under one load that is observed where it acts.

    Each step, in the displacements (Bathe, Finite Element Procedures, chapter 9; n unknowns), takes

    - 2 for the place of the load within its element: step × distance per step, then one division by the element;
    - 7 for the four cubic functions N at that place s: s², s² (3 − 2 s), and with r = 1 − s and the length L of the
      element L s r, (L s r) r and (L s r) s;
    - 4 for the load on the unknowns, N F;
    - 6 n for the two sums a₀ u + a₂ v + a₃ a and a₁ u + a₄ v + a₅ a;
    - 2 n² for their products with the full matrices of mass and damping;
    - n² for the solution with the full factors L D Lᵀ: n (n − 1)/2 forward, n by D, n (n − 1)/2 back;
    - 3 n for the new acceleration a₀ (u⁺ − u) − a₂ v − a₃ a;
    - 2 n for the new velocity v + a₆ a + a₇ a⁺;
    - 4 for the deflection under the load, N u⁺.

    Together 3 n² + 11 n + 17 per step.

    Parameters
    ----------
    dofs : int
        Number of unknowns n.
    steps : int
        Number of steps in time.

    Returns
    -------
    int
        Multiplications; those of the factorisation and of the state at the start are not counted.

    Raises
    ------
    ValueError
        If a number is not whole or less than one.

    Examples
    --------
    >>> newmark_full(480, 10_000)
    6964970000
    """
    _require_whole(dofs=dofs, steps=steps)
    place, functions, load, deflection = 2, 7, 4, 4
    sums, products = 6 * dofs, 2 * dofs**2
    solution = 2 * (dofs * (dofs - 1) // 2) + dofs
    acceleration, velocity = 3 * dofs, 2 * dofs
    once = place + functions + load + deflection
    return steps * (once + sums + products + solution + acceleration + velocity)


def newmark_banded(dofs: int, steps: int) -> int:
    """Count for Newmark's method as `stepping.compiled.march` has it, under one load observed where it acts.

    A road that stands still, bands of half-width 3, average acceleration, no vehicle. Each step takes, as the loop
    is written (n unknowns),

    - 2 for the distance travelled;
    - 2 × 20 for the cubic functions (12), their slopes (7) and the place (1): at the load and at the observer,
      which the loop does not know to be one point;
    - 5 n for what displacement and velocity would be without a new acceleration: 3 n and 2 n;
    - 2 (7 n − 12) for the products with the bands of stiffness and damping, 7 entries to a row except at the ends;
    - 8 for the load on the unknowns, (1 − α_f) N F;
    - 14 h + 12 + q² for the solution: h = (n − q)/2 rows from either end, with 3 products on the way to the middle
      and 4 on the way back; 2 × 6 where they meet the core, and the q × q inverse of that core. q is 3 if n is odd
      and 4 if it is even, and the sum is 7 n for both;
    - 5 n for the new displacement and velocity: 3 n and 2 n;
    - 2 × 4 for the deflection, at the load and at the observer.

    Together 31 n + 34 per step.

    Parameters
    ----------
    dofs : int
        Number of unknowns n, at least 9.
    steps : int
        Number of steps in time.

    Returns
    -------
    int
        Multiplications of the loop; those of the factorisation and of the state at the start are not counted.

    Raises
    ------
    ValueError
        If a number is not whole, there are fewer than 9 unknowns, or fewer than one step.

    Examples
    --------
    >>> newmark_banded(480, 10_000)
    149140000
    """
    _require_whole(steps=steps)
    _require_whole(STRIDE.fewest_unknowns, dofs=dofs)
    travelled, functions, load, deflection = 2, 2 * 20, 8, 2 * 4
    width = 3  # half-width of the bands; the compiled loop, which has it too, cannot be read without numba
    # At either end of the matrix, three rows lack 3, 2 and 1 of the entries that the others have.
    missing = width * (width + 1) // 2
    product = 2 * ((2 * width + 1) * dofs - 2 * missing)
    core = 4 - dofs % 2
    half = (dofs - core) // 2
    solution = 2 * (width + width + 1) * half + 2 * missing + core**2
    once = travelled + functions + load + deflection
    return steps * (once + 5 * dofs + product + solution + 5 * dofs)


def duhamel(samples: int, memory: int) -> int:
    """Count for Duhamel's integral as a direct sum: one load and one point, in the frame that travels with both.

    The deflection at step n is the sum of min(n + 1, memory) products of a weight (the moving impulse response
    times the time step) and a force up to then: memory × samples − memory (memory − 1)/2 altogether, if the
    response is not longer than the record.

    `duhamel_loads` sums the same products, but by `np.convolve`, which forms memory × samples of them: it goes on
    past the last step until the response has faded, and what lies there is discarded. The force at the first step,
    whose hat is halved, it takes apart, by about `memory` products more.

    Parameters
    ----------
    samples : int
        Number of steps in time.
    memory : int
        Number of samples of the impulse response, the one at the impulse included.

    Returns
    -------
    int
        Multiplications of the direct sum; those that make the weights, one for each, are not counted.

    Raises
    ------
    ValueError
        If a number is not whole or less than one.

    Examples
    --------
    >>> duhamel(10_000, 2000)
    18001000
    >>> duhamel(3, 10) == 1 + 2 + 3
    True
    """
    _require_whole(samples=samples, memory=memory)
    longest = min(samples, memory)
    return longest * samples - longest * (longest - 1) // 2


def moving_frf(frequencies: int, loads: int = 1, points: int = 1) -> int:
    """Count for moving FRF times spectrum of force: one complex product per frequency, load and point.

    A complex product (a + ib)(c + id) takes four real ones: a c, b d, a d, b c. The transforms of forces and
    deflections (see `real_fft`) are not included.

    `moving_loads` pads its record for the response to die away in, so that there are more frequencies below a
    truncation than the record alone would have: `Truncation.reach`.

    Parameters
    ----------
    frequencies : int
        Number of frequencies kept, zero included; from 0 to f of a record of length T they are f T + 1.
    loads : int
        Number of loads.
    points : int
        Number of observation points.

    Returns
    -------
    int
        Multiplications.

    Raises
    ------
    ValueError
        If a number is not whole or less than one.

    Examples
    --------
    0 to 70 Hz of 10 s:

    >>> moving_frf(70 * 10 + 1)
    2804
    """
    _require_whole(frequencies=frequencies, loads=loads, points=points)
    return 4 * frequencies * loads * points


def real_fft(points: int) -> int:
    """Count for the fast Fourier transform, of radix 2, of a real record of length N = 2^p.

    Even and odd samples become the real and imaginary parts of N/2 complex ones (Cooley and Tukey 1965; Press et
    al., Numerical Recipes, section 12.3). This takes

    - N (p − 1) for the complex transform: p − 1 stages of N/4 butterflies, each with one complex product of four
      real ones, trivial factors such as 1 and −i counted as all others;
    - 6 (N/4 − 1) to part the two again: the frequencies k and N/2 − k share one complex product and the two
      halvings of a complex sum; at 0, N/4 and N/2 there is nothing to multiply.

    Together N (p + ½) − 6, and nothing for N < 4, where sums are enough. This is the textbook's count: the
    package's own transforms are NumPy's, which take any length and larger radices.

    Parameters
    ----------
    points : int
        Number of samples; the next power of two counts.

    Returns
    -------
    int
        Multiplications.

    Raises
    ------
    ValueError
        If the number is not whole or less than one.

    Examples
    --------
    >>> real_fft(16_384), real_fft(10_000)
    (237562, 237562)
    """
    _require_whole(points=points)
    power = (points - 1).bit_length()
    size = 2**power
    if size < 4:
        return 0
    return size * (power - 1) + 6 * (size // 4 - 1)


def _require_whole(least: int = 1, **numbers: int) -> None:
    with checking() as check:
        for name, number in numbers.items():
            check.whole(name, number, least=least)
