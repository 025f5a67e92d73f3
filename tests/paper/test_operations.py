"""The formulas for multiplications, against counts: numbers that count what they are multiplied with."""

from __future__ import annotations

import math
import operator

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response.line import Line
from movingfrf.response.sampling import SAMPLING, Driving, excited
from movingfrf.response.system import Prescribed
from movingfrf.response.truncation import Truncation
from movingfrf.studies.paper import operations
from tests.helpers import DAMPED, difference

TRACK = DAMPED["euler_bernoulli_winkler"]


def operation(function, weight):
    """Make an operation on two numbers that counts as so many multiplications."""

    def operate(self, other):
        Counted.taken += weight
        return Counted(function(self.value, float(other)))

    return operate


class Counted:
    """A real number; every product and quotient that it takes part in is counted, sums are not."""

    taken = 0

    def __init__(self, value):
        self.value = float(value)

    def __float__(self):
        """Let NumPy and the tests have the number."""
        return self.value

    def __eq__(self, other):
        """Compare as numbers, as the loop does with zero."""
        return self.value == float(other)

    def __neg__(self):
        """Change the sign, which is no multiplication."""
        return Counted(-self.value)

    __hash__ = None
    __add__ = __radd__ = operation(operator.add, 0)
    __sub__ = operation(operator.sub, 0)
    __rsub__ = operation(lambda one, other: other - one, 0)
    __mul__ = __rmul__ = operation(operator.mul, 1)
    __truediv__ = operation(operator.truediv, 1)
    __rtruediv__ = operation(lambda one, other: other / one, 1)


# Arrays of numbers → object arrays of numbers that count.
counted = np.frompyfunc(Counted, 1, 1)


class CountingNumpy:
    """As much of NumPy as the compiled loop uses; its arrays of real numbers count, its indices do not."""

    int64 = np.int64

    @staticmethod
    def zeros(shape, kind=float):
        return np.zeros(shape, kind) if kind is np.int64 else np.asarray(counted(np.zeros(shape)))

    @staticmethod
    def empty(shape):
        return np.empty(shape, object)

    @staticmethod
    def floor(number):
        return math.floor(float(number))


@pytest.fixture(autouse=True)
def count():
    """Begin each test at zero; returns what was taken since the last look."""
    Counted.taken = 0

    def since():
        taken, Counted.taken = Counted.taken, 0
        return taken

    return since


def test_every_product_and_quotient_counts_once_and_nothing_else(count):
    number, row = Counted(3.0), counted(np.array([1.0, 2.0, 4.0]))
    found = [number * 2, 2.0 * number, np.float64(2.0) * number, number / 2, 6 / number]
    assert [float(each) for each in found] == [6.0, 6.0, 6.0, 1.5, 2.0]
    assert count() == 5
    found = [number + 1, 1 + number, number - 1, 1 - number, -number]
    assert [float(each) for each in found] == [4.0, 4.0, 2.0, -2.0, -3.0]
    assert count() == 0
    assert float(row @ row) == 21.0
    assert count() == 3
    assert (2.0 * row).astype(float).tolist() == [2.0, 4.0, 8.0]
    assert count() == 3


def forces_of(steps):
    return 1e5 * (1.0 + 0.3 * np.sin(0.7 * np.arange(steps + 1)))[:, None]


# The load crosses two nodes, at 1.2 and 1.6 m; on the shortest road it ends up beside what holds the end.
CASE = {"positions": [1.1], "speed": 10.0, "time_step": 7e-3}


def road_of(elements, ends="pinned"):
    return mf.finite_track(TRACK, first=0.0, last=0.4 * elements, element=0.4, ends=ends)


def stepped(road, steps, compiled=None):
    return mf.newmark_loads(road, forces_of(steps), compiled=compiled, **CASE).deflection.values[:, 0]


def counting(value):
    """Let real numbers count, alone, in arrays and in tuples of both."""
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value)(*map(counting, value))
    return counted(value) if np.asarray(value).dtype.kind == "f" else value


def counting_march(monkeypatch, count, taken):
    """Put in place of `compiled.march` its own source, run by Python with numbers that count."""
    from movingfrf.stepping import compiled

    functions = {name: f.py_func for name, f in vars(compiled).items() if hasattr(f, "py_func")}

    def march(*arguments):
        given = [counting(each) for each in arguments]
        with pytest.MonkeyPatch.context() as patch:
            for name, function in functions.items():
                patch.setattr(compiled, name, function)
            patch.setattr(compiled, "np", CountingNumpy)
            count()
            answer = functions["march"](*given)
            taken.append(count())
        # The state and the records are written in place.
        for each, seen in zip(arguments, given, strict=True):
            if isinstance(each, np.ndarray) and each.flags.writeable:
                each[...] = seen
        return answer

    monkeypatch.setattr(compiled, "march", march)


@pytest.mark.parametrize(
    ("elements", "ends", "dofs"),
    [(5, ("pinned", "clamped"), 9), (6, "pinned", 12), (12, "pinned", 24), (12, ("pinned", "clamped"), 23)],
)
def test_banded_newmark_is_the_compiled_loop(elements, ends, dofs, monkeypatch, count):
    """The loop's own source, so that whoever changes the loop learns that the paper's table changes.

    Python rounds every product, the compiled loop some products together with a sum: they differ by rounding.
    """
    pytest.importorskip("numba")
    road = road_of(elements, ends)
    assert road.dofs == dofs
    wanted = stepped(road, 8, compiled=True)
    taken: list[int] = []
    counting_march(monkeypatch, count, taken)
    assert difference(stepped(road, 8, compiled=True), wanted) < 1e-12
    stepped(road, 3, compiled=True)
    # The same start in both: what differs is five steps.
    assert taken[0] - taken[1] == operations.newmark_banded(dofs, 5)


def cubic(s, element):
    """Cubic functions with as few products as possible: 7."""
    rest, square = 1.0 - s, s * s
    second = square * (3.0 - 2.0 * s)
    both = element * s * rest
    return np.array([1.0 - second, both * rest, second, -(both * s)])


def solved(lower, pivots, right):
    """L D Lᵀ x = right with full factors, in place."""
    n = len(right)
    for i in range(1, n):
        right[i] -= lower[i, :i] @ right[:i]
    right /= pivots
    for i in range(n - 2, -1, -1):
        right[i] -= lower[i + 1 :, i] @ right[i + 1 :]
    return right


def textbook_newmark(road, forces, *, positions, speed, time_step, count):
    """Bathe's form of Newmark's average acceleration, one load; deflections under it and multiplications."""
    mass, damping, stiffness = (each.toarray() for each in (road.mass, road.damping, road.stiffness))
    beta, gamma, dt = 1 / 4, 1 / 2, time_step
    a0, a1, a2, a3 = 1 / (beta * dt**2), gamma / (beta * dt), 1 / (beta * dt), 1 / (2 * beta) - 1
    a4, a5, a6, a7 = gamma / beta - 1, dt / 2 * (gamma / beta - 2), dt * (1 - gamma), gamma * dt
    start = road.rows(np.array(positions)).toarray()[0]
    cholesky = np.linalg.cholesky(stiffness + a0 * mass + a1 * damping)
    diagonal = np.diag(cholesky)
    lower, pivots = counted(cholesky / diagonal), counted(diagonal**2)
    u, v = counted(np.zeros((2, road.dofs)))
    a = counted(np.linalg.solve(mass, start * forces[0, 0]))
    mass, damping, element = counted(mass), counted(damping), Counted(road.mesh.element)
    deflection, per_step = [0.0], Counted(speed * dt)
    count()
    for step in range(1, len(forces)):
        at = (positions[0] - road.mesh.first + step * per_step) / element
        e = int(float(at))
        values, here = cubic(at - e, element), road.mesh.number[2 * e : 2 * e + 4]
        right = mass @ (a0 * u + a2 * v + a3 * a) + damping @ (a1 * u + a4 * v + a5 * a)
        right[here] += values * forces[step, 0]
        new = solved(lower, pivots, right)
        fresh = a0 * (new - u) - a2 * v - a3 * a
        u, v, a = new, v + a6 * a + a7 * fresh, fresh
        deflection.append(float(values @ u[here]))
    return np.array(deflection), count()


@pytest.mark.parametrize(("elements", "steps"), [(6, 8), (9, 5), (14, 8)])
def test_full_newmark_is_the_textbook(elements, steps, count):
    """Same scheme in other unknowns: what differs is rounding, some 1e-16 times the condition of the matrix."""
    road = road_of(elements)
    deflection, taken = textbook_newmark(road, forces_of(steps), count=count, **CASE)
    assert difference(deflection, stepped(road, steps)) < 1e-9
    assert taken == operations.newmark_full(road.dofs, steps)


@pytest.mark.filterwarnings("ignore:the moving impulse response has not died away")
@pytest.mark.parametrize(("samples", "memory"), [(12, 5), (8, 8), (6, 10)])
def test_duhamel_is_the_direct_sum(samples, memory, count):
    """The same sum in another order: rounding apart.

    The first force acts by half of its hat, the response at the impulse by half of its; a deflection that begins
    with zero, as that of any road with a mass, leaves nothing of the latter.
    """
    step, forces = 1e-2, forces_of(samples - 1)
    after = step * np.arange(memory)
    ringing = 1e-6 * np.exp(-5 * after) * np.sin(40 * after)
    road = mf.SampledGuideway(response=ringing[:, None], time_step=step, offsets=[0.0], speed=10.0, stepped=True)
    wanted = mf.duhamel_loads(road, forces, [0.0], speed=10.0, time_step=step).deflection.values[:, 0]
    history = forces[:, 0].copy()
    history[0] *= 0.5
    weights, history = counted(step * ringing), counted(history)
    sums = [sum(weights[k] * history[n - k] for k in range(min(n + 1, memory))) for n in range(samples)]
    assert difference(np.array(sums).astype(float), wanted) < 1e-12
    assert count() == operations.duhamel(samples, memory)


def times(one, other):
    """Complex product of two pairs (real, imaginary)."""
    (a, b), (c, d) = one, other
    return a * c - b * d, a * d + b * c


def plus(one, other):
    return one[0] + other[0], one[1] + other[1]


def minus(one, other):
    return one[0] - other[0], one[1] - other[1]


def conjugate(one):
    return one[0], -one[1]


def pairs(array):
    """Complex array → object array of pairs."""
    made = np.empty(array.shape, object)
    for place, value in np.ndenumerate(array):
        made[place] = (Counted(value.real), Counted(value.imag))
    return made


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(("positions", "points"), [([0.0], [0.0]), ([0.0, -1.5], [0.5, 0.0, -2.0])])
def test_moving_frf_is_four_products_per_frequency(positions, points, count):
    """Between the package's own transforms the products give the package's own deflections, to rounding."""
    step, truncation, samples = 5e-3, 40.0, 40
    forces = np.repeat(forces_of(samples - 1), len(positions), axis=1) * (1.0 + np.arange(len(positions)))
    wanted = mf.moving_loads(
        TRACK, forces, positions, speed=10.0, time_step=step, observe=points, truncation=truncation
    ).deflection.values
    solved = excited(
        Prescribed(guideway=TRACK, loads=np.array(positions), points=np.array(points), speed=10.0),
        Driving(lambda line: line.given(forces.T), step),
        Line(samples=samples, time_step=step, cut=Truncation(frequency=truncation).width),
        truncation=np.inf,
        wanted=SAMPLING.loads,
    )
    line, cut = solved.line, Truncation(frequency=truncation)
    kept = cut.reach(line.omega())
    omega = line.omega()[:kept]
    frf = TRACK.moving_frf(np.subtract.outer(points, positions), 10.0, omega)
    frf = pairs(frf * cut.taper(omega)[:, None, None])
    spectra = pairs(solved.spectra[0].T[:kept])
    deflection = np.zeros((kept, len(points)), complex)
    for (frequency, point, load), value in np.ndenumerate(frf):
        real, imaginary = times(value, spectra[frequency, load])
        deflection[frequency, point] += complex(float(real), float(imaginary))
    # Nothing moves before the forces act.
    assert difference(line.records(deflection.T).values.T[1:], wanted[1:]) < 1e-12
    assert 10 < kept < line.size
    assert count() == operations.moving_frf(kept, len(positions), len(points))


def turn(share):
    """Return e^{−2πi share}."""
    return math.cos(2 * math.pi * share), -math.sin(2 * math.pi * share)


def transformed(values):
    """Cooley and Tukey's complex transform, radix 2, of a list of pairs."""
    n = len(values)
    if n == 1:
        return values
    even, odd = transformed(values[::2]), transformed(values[1::2])
    odd = [times(turn(k / n), value) for k, value in enumerate(odd)]
    return [*map(plus, even, odd), *map(minus, even, odd)]


def real_transformed(record):
    """Transform of a real record from that of half as many complex numbers; frequencies 0 to n/2."""
    half = len(record) // 2
    packed = transformed(list(zip(record[::2], record[1::2], strict=True)))
    (real, imaginary), spectrum = packed[0], [*packed, None]
    spectrum[0], spectrum[half] = (real + imaginary, 0.0), (real - imaginary, 0.0)
    for k in range(1, (half + 1) // 2):
        here, there = packed[k], conjugate(packed[half - k])
        even = tuple(0.5 * part for part in plus(here, there))
        cosine, sine = turn(k / len(record))
        odd = times((0.5 * sine, -0.5 * cosine), minus(here, there))
        spectrum[k], spectrum[half - k] = plus(even, odd), conjugate(minus(even, odd))
    if half > 1:
        spectrum[half // 2] = conjugate(packed[half // 2])
    return spectrum


@pytest.mark.parametrize(("points", "size"), [(2, 2), (4, 4), (8, 8), (50, 64), (256, 256)])
def test_real_fft_is_radix_two(points, size, count):
    record = np.zeros(size)
    record[:points] = np.random.default_rng(1).standard_normal(points)
    found = real_transformed(list(counted(record)))
    assert count() == operations.real_fft(points)
    spectrum = np.array([complex(float(real), float(imaginary)) for real, imaginary in found])
    np.testing.assert_allclose(spectrum, np.fft.rfft(record), rtol=0, atol=1e-12 * np.abs(spectrum).max())


def test_one_point_is_its_own_transform():
    assert operations.real_fft(1) == 0


@pytest.mark.parametrize(
    ("formula", "arguments", "refused"),
    [
        (operations.newmark_full, (0, 1), "dofs"),
        (operations.newmark_full, (1, 0), "steps"),
        (operations.newmark_banded, (8, 1), "dofs must be a whole number of at least 9"),
        (operations.newmark_banded, (9, 0), "steps"),
        (operations.duhamel, (0, 1), "samples"),
        (operations.duhamel, (1, 0), "memory"),
        (operations.moving_frf, (0,), "frequencies"),
        (operations.moving_frf, (1, 0), "loads"),
        (operations.moving_frf, (1, 1, 0), "points"),
        (operations.real_fft, (0,), "points"),
        (operations.real_fft, (2.5,), "points"),
    ],
)
def test_numbers_that_count_nothing_are_refused(formula, arguments, refused):
    with pytest.raises(ValueError, match=refused):
        formula(*arguments)
