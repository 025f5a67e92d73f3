"""Matrices, hinges, rigid contacts, the vehicles that functions fill."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault(
        "all cars alike", "vehicles/dynamics.py", "if same in found:", "if found and (same := next(iter(found))):"
    ),
    # Coupling.
    Fault("footprint twice as long", "_basics/enveloping.py", "half = 0.5 *", "half = 1.0 *"),
    Fault("cams twice as far apart", "_basics/enveloping.py", "0.5 * cams", "1.0 * cams"),
    # Vehicle.
    Fault(
        "tyres in the matrix not recognised",
        "vehicles/vehicle.py",
        "np.abs(resisted - theirs)",
        "np.abs(resisted + theirs)",
    ),
    Fault("missing vertical not asked for", "vehicles/files.py", 'if "vertical" in arrays or', "if True or"),
    Fault(
        "numbers stored as they came",
        "_basics/checks.py",
        "checks.values[field.name])",
        "getattr(owner, field.name))",
    ),
    Fault("arrays without axes refused", "_basics/checks.py", "return value.item() if", "return value if"),
    Fault(
        "checked, and not used",
        "vehicles/cars.py",
        'pitch_inertia = check.positive("pitch_inertia", pitch_inertia, "kg m²")\n        roll',
        'check.positive("pitch_inertia", pitch_inertia, "kg m²")\n        roll',
    ),
    Fault("gravity", "vehicles/vehicle.py", "GRAVITY = 9.81", "GRAVITY = 9.80665"),
    Fault("tyre damping missing", "vehicles/dynamics.py", "np.diag(dashpots)", "0.0 * np.diag(dashpots)"),
    Fault("inertia sign", "vehicles/dynamics.py", "(linear + s * square)", "(linear - s * square)"),
    Fault("rigid motion turned", "vehicles/dynamics.py", "free[bound] = -inverse", "free[bound] = inverse"),
    Fault(
        "inertia above rigid contacts missing",
        "vehicles/dynamics.py",
        ".T + prescribed.T @ a @ prescribed",
        ".T + 0.0 * prescribed.T @ a @ prescribed",
    ),
    Fault(
        "force on the vehicle for that on the road",
        "vehicles/dynamics.py",
        "force -= self.direct",
        "force += self.direct",
    ),
    Fault("weight above rigid contacts missing", "vehicles/vehicle.py", "(self.weights - impedance", "(-impedance"),
    Fault(
        "tipping vehicles accepted",
        "vehicles/vehicle.py",
        "np.flatnonzero(~(loads > 0))",
        "np.flatnonzero(loads != loads)",
    ),
    Fault(
        "nose up",
        "vehicles/assembly.py",
        "(position - self.position, self.pitch_inertia)",
        "(self.position - position, self.pitch_inertia)",
    ),
    Fault(
        "right side down",
        "vehicles/assembly.py",
        "(across - self.across, self.roll_inertia)",
        "(self.across - across, self.roll_inertia)",
    ),
    Fault(
        "wheels weightless",
        "vehicles/assembly.py",
        "self.downward.add(body.dof_names[0])",
        "self.downward.update(body.dof_names[:1] if n == 0 else [])",
    ),
    Fault("hitch turned", "vehicles/assembly.py", "free[given_up] = -np.linalg", "free[given_up] = np.linalg"),
    Fault("dampers left out", "vehicles/assembly.py", "suspension.damping * square", "0.0 * square"),
    Fault("convoy ahead of itself", "vehicles/combined.py", "behind = -np.concatenate", "behind = np.concatenate"),
    Fault("both seats on the floor", "vehicles/combined.py", "        below = above\n", ""),
    Fault("half a wheel on each side", "vehicles/trucks.py", "(0.5, sides[1], 1", "(1.0, sides[1], 1"),
    Fault("Hertz' exponent", "vehicles/rail.py", "1.5 / constant", "1.0 / constant"),
    Fault("rear bogie ahead", "vehicles/rail.py", '"bogie_2": -0.5 * apart', '"bogie_2": 0.6 * apart'),
    Fault("contacts transposed", "vehicles/vehicle.py", "ahead[:, None] - ahead", "ahead - ahead[:, None]"),
    Fault(
        "left and right transposed", "vehicles/vehicle.py", "across[:, None] - across", "across - across[:, None]"
    ),
    Fault(
        "receiver's place for the source's",
        "vehicles/vehicle.py",
        "np.broadcast_to(across, offsets",
        "np.broadcast_to(across[:, None], offsets",
    ),
    Fault("paths exchanged", "vehicles/cars.py", "path=side", "path=1 - side"),
    Fault(
        "wheels exchanged across",
        "vehicles/cars.py",
        "path=side,\n                across=aside[side]",
        "path=side,\n                across=aside[1 - side]",
    ),
    Fault("spring without its dashpot", "vehicles/oscillator.py", "damping=damping, footprint", "footprint"),
    Fault("footprints of the catalogue kept", "vehicles/catalogue.py", "replace(own, footprint=length)", "own"),
]
