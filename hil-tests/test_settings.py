"""Settings that a board keeps: lowered for good, never raised above what is compiled in."""

import dataclasses

import pytest

from zygote_wire import commands
from zygote_wire.codes import Refused
from zygote_wire.link import CommandRefused, Link
from zygote_wire.reports import Done, Refusal, SettingsReport


pytestmark = pytest.mark.smoke


def settings(link: Link) -> SettingsReport:
    """What the board keeps."""
    return link.request(commands.AskSettings())


@pytest.fixture
def compiled(link):
    """What is compiled into the board, which is left as it was found."""
    before = settings(link)
    yield before.compiled
    link.request(commands.Configure(before.in_force))


def test_a_lowered_limit_is_kept_and_told_by_every_later_hello(link, compiled):
    ceiling = dataclasses.replace(compiled.ceiling, supply=compiled.ceiling.supply - 1)
    lowered = dataclasses.replace(compiled, ceiling=ceiling)
    assert link.request(commands.Configure(lowered)) == Done()
    report = settings(link)
    assert (report.in_force, report.compiled) == (lowered, compiled)
    assert link.hello().ceiling == ceiling


def test_no_setting_is_raised_above_what_is_compiled_in(link, compiled):
    ceiling = dataclasses.replace(compiled.ceiling, supply=compiled.ceiling.supply + 1)
    before = settings(link).in_force
    with pytest.raises(CommandRefused) as refused:
        link.request(commands.Configure(dataclasses.replace(compiled, ceiling=ceiling)))
    most = compiled.ceiling.supply
    assert refused.value.refusal == Refusal(Refused.LIMIT_ABOVE_CEILING, 3, most, most + 1)
    assert settings(link).in_force == before
