"""What kind of thing a quantity measures: integer exponents over base dimensions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Dimension:
    """Exponents of the base dimensions, all 0 for a plain number.

    Angle is a base dimension here, unlike in the SI, so that a torque is no energy and `deg/s` no frequency.
    `spin` counts relative centrifugal force (`xg`), which depends on a rotor and is not an acceleration that
    can be compared with others. `point` tells a temperature (37 degC) from a difference (5 K).
    """

    length: int = 0
    mass: int = 0
    time: int = 0
    temperature: int = 0
    angle: int = 0
    amount: int = 0
    spin: int = 0
    point: bool = field(default=False, kw_only=True)

    @property
    def name(self) -> str:
        """The name that messages use, such as `Volume` or, where there is none, `Length^2/Time`."""
        return DIMENSION_NAMES.get(self) or self._composed(_BASE_NAMES)

    @property
    def base_unit(self) -> str:
        """The dimension spelled in base units, such as `m^2/s`; empty for a plain number."""
        return "" if self == NUMBER else self._composed(_BASE_UNITS)

    @property
    def difference(self) -> Dimension:
        """The dimension of the difference of two such quantities: the same, but for points."""
        return Dimension(*self._exponents()) if self.point else self

    def times(self, other: Dimension, sign: int = 1) -> Dimension:
        """The dimension of a product, or with `sign=-1` of a quotient; neither side may be a point."""
        pairs = zip(self._exponents(), other._exponents(), strict=True)
        return Dimension(*(a + sign * b for a, b in pairs))

    def _exponents(self) -> tuple[int, int, int, int, int, int, int]:
        return self.length, self.mass, self.time, self.temperature, self.angle, self.amount, self.spin

    def _composed(self, words: tuple[str, ...]) -> str:
        above: list[str] = []
        below: list[str] = []
        for word, exponent in zip(words, self._exponents(), strict=True):
            if exponent:
                power = abs(exponent)
                (above if exponent > 0 else below).append(word if power == 1 else f"{word}^{power}")
        return "/".join(["*".join(above) or "1", *below])


_BASE_NAMES = ("Length", "Mass", "Time", "TemperatureDifference", "Angle", "Amount", "CentrifugalForce")
_BASE_UNITS = ("m", "kg", "s", "K", "rad", "mol", "xg")

NUMBER = Dimension()
LENGTH = Dimension(length=1)
VOLUME = Dimension(length=3)
MASS = Dimension(mass=1)
TIME = Dimension(time=1)
FREQUENCY = Dimension(time=-1)
TEMPERATURE = Dimension(temperature=1, point=True)
TEMPERATURE_DIFFERENCE = Dimension(temperature=1)
ANGLE = Dimension(angle=1)
AMOUNT = Dimension(amount=1)
SPEED = Dimension(length=1, time=-1)
ACCELERATION = Dimension(length=1, time=-2)
ANGULAR_SPEED = Dimension(angle=1, time=-1)
ANGULAR_ACCELERATION = Dimension(angle=1, time=-2)
FORCE = Dimension(mass=1, length=1, time=-2)
TORQUE = Dimension(mass=1, length=2, time=-2)
FLOW = Dimension(length=3, time=-1)
MOLAR_CONCENTRATION = Dimension(amount=1, length=-3)
MASS_CONCENTRATION = Dimension(mass=1, length=-3)
CENTRIFUGAL_FORCE = Dimension(spin=1)

DIMENSION_NAMES: Mapping[Dimension, str] = MappingProxyType(
    {
        NUMBER: "Number",
        LENGTH: "Length",
        VOLUME: "Volume",
        MASS: "Mass",
        TIME: "Time",
        FREQUENCY: "Frequency",
        TEMPERATURE: "Temperature",
        TEMPERATURE_DIFFERENCE: "TemperatureDifference",
        ANGLE: "Angle",
        AMOUNT: "Amount",
        SPEED: "Speed",
        ACCELERATION: "Acceleration",
        ANGULAR_SPEED: "AngularSpeed",
        ANGULAR_ACCELERATION: "AngularAcceleration",
        FORCE: "Force",
        TORQUE: "Torque",
        FLOW: "Flow",
        MOLAR_CONCENTRATION: "Concentration (molar)",
        MASS_CONCENTRATION: "Concentration (mass per volume)",
        CENTRIFUGAL_FORCE: "CentrifugalForce",
    }
)

TYPE_DIMENSIONS: Mapping[str, tuple[Dimension, ...]] = MappingProxyType(
    {
        "Volume": (VOLUME,),
        "Length": (LENGTH,),
        "Mass": (MASS,),
        "Time": (TIME,),
        "Temperature": (TEMPERATURE,),
        "TemperatureDifference": (TEMPERATURE_DIFFERENCE,),
        "Angle": (ANGLE,),
        "Speed": (SPEED,),
        "AngularSpeed": (ANGULAR_SPEED,),
        "Force": (FORCE,),
        "Acceleration": (ACCELERATION,),
        "Frequency": (FREQUENCY,),
        "Flow": (FLOW,),
        "Amount": (AMOUNT,),
        "CentrifugalForce": (CENTRIFUGAL_FORCE,),
        "Concentration": (MOLAR_CONCENTRATION, MASS_CONCENTRATION),
    }
)
"""The quantity types of the language, each with the dimensions that a value of it may have."""
