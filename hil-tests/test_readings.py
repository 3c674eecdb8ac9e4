"""Thermistors, before anything is heated."""

import statistics

import pytest

from zygote_wire import commands
from zygote_wire.commands import Heat
from zygote_wire.link import Link
from zygote_wire.reports import Reading

pytestmark = pytest.mark.smoke

# °C: a room in which a bench stands, and how far apart two of its thermistors may be.
ROOM = (5.0, 45.0)
MOST_APART = 3.0


def readings(link: Link) -> dict[int, Reading]:
    """Every heater's reading."""
    told: dict[int, Reading] = {}
    while reply := link.request(commands.Readings(len(told))).channels:
        told |= {len(told) + place: reading for place, reading in enumerate(reply)}
    return told


def test_the_thermistors_of_all_hinges_tell_one_room_and_no_heater_is_on(link, program, mcu, measure):
    told = readings(link)
    assert len(told) == mcu.channels.heaters
    assert {reading.duty for reading in told.values()} == {0}
    channels = [step.action.channel for step in program.steps if isinstance(step.action, Heat)]
    unbelievable = [channel for channel in channels if told[channel].temperature is None]
    assert not unbelievable, "these thermistors are open, shorted or not there"
    room = statistics.median(told[channel].temperature / 100 for channel in channels)
    for channel in channels:
        here = told[channel].temperature / 100
        measure(f"thermistor {channel}", here, "°C", *ROOM)
        measure(f"thermistor {channel} from the median", here - room, "K", -MOST_APART, MOST_APART)
