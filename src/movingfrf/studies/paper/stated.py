"""What the paper states in numbers, and what stands in for that which its text does not have."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """Numbers of the paper."""

    truncation: float = 70.0  # frequency up to which the moving FRF is taken [Hz]
    truncation_error: float = 1e-4  # what the error falls below for higher truncations
    falling: float = 17.0  # frequency beyond which the moving FRF falls [Hz]
    width: float = 3.0  # of the road in three dimensions [m]
    # The road that Newmark's method is applied to: 240 elements [m].
    newmark_length: float = 120.0
    newmark_element: float = 0.5
    # Times in the last table, on the authors' computer [s].
    cdfm_time: float = 1610.0
    sim_time: float = 686.0
    moving_frf_time: float = 5.9


STATED = Stated()


@dataclass(frozen=True, slots=True, kw_only=True)
class Substitutes:
    """What stands in for parameters, histories and profiles of the paper: numbers, and sentences for the page."""

    newmark_start: float = 10.0  # where the load starts on the road for Newmark's method, from its end [m]
    poisson: float = 0.35  # Poisson's ratio of asphalt
    road: str = (
        "The road's parameters stand in a table that the text of the paper does not have. Substitute: a published "
        "pavement beam (EI = 1.573 × 10⁷ N m², m = 711.9 kg/m, k = 8 × 10⁶ N/m², c = 3 × 10⁴ N s/m² per metre of "
        "width; Ding, Chen and Yang, J. Sound Vib. 331, 2012, with a lower damping) times the 3 m that the paper "
        "gives its three-dimensional road. Its √(k/m)/2π is 16.9 Hz."
    )
    load: str = (
        "The load's history is a figure of the paper. Substitute: a constant with a seeded sum of harmonics below "
        "60 Hz, switched on and off over 0.2 s (scenario load) or within one step (scenario load_abrupt)."
    )
    vehicle: str = (
        "The vehicle's parameters stand in a table that the text of the paper does not have. Substitute: the half "
        "truck of Mulcahy, and Law and Zhu (values as commonly quoted, not checked against the source)."
    )
    roughness: str = (
        "The profile is a figure of the paper. Substitute: a seeded realisation of class A of ISO 8608, 0.01 to 10 "
        "cycles/m."
    )

    @property
    def plate(self) -> str:
        """The road in three dimensions."""
        return (
            "The three-dimensional model is not described further. Substitute: an isotropic thin plate with free "
            f"edges (Poisson's ratio {self.poisson:g}) on a viscoelastic foundation, {STATED.width:g} m wide, "
            "which carries, weighs and bends per width what the beam does on the whole; the half truck with half "
            "of each axle at either side, 2 m apart, and a roll inertia (scenario truck_3d)."
        )


SUBSTITUTES = Substitutes()
