"""One measured value with its limits, as OpenHTF's records have it."""

import dataclasses

# A value that is nearer to a limit than this part of the room between its limits passes, and is told as marginal.
MARGIN = 0.1


@dataclasses.dataclass(frozen=True)
class Measurement:
    """A value with a unit and what it must lie between, both ends included."""

    name: str
    value: float
    unit: str
    low: float | None = None
    high: float | None = None

    @property
    def passed(self) -> bool:
        """Whether it is within its limits."""
        return (self.low is None or self.value >= self.low) and (self.high is None or self.value <= self.high)

    @property
    def marginal(self) -> bool:
        """Whether it is within its limits, but barely."""
        ends = [end for end in (self.low, self.high) if end is not None]
        if not ends or not self.passed:
            return False
        room = abs(ends[-1] - ends[0]) if len(ends) == 2 else abs(ends[0])
        return any(abs(self.value - end) < MARGIN * room for end in ends)

    def __str__(self) -> str:
        low = "" if self.low is None else f"{self.low:g} <= "
        high = "" if self.high is None else f" <= {self.high:g}"
        return f"{self.name}: {low}{self.value:g} {self.unit}{high}"

    def record(self) -> dict[str, object]:
        """As it stands in a record."""
        return {
            "name": self.name,
            "measured_value": self.value,
            "units": self.unit,
            "limits": {"low": self.low, "high": self.high},
            "marginal": self.marginal,
            "outcome": "PASS" if self.passed else "FAIL",
        }
