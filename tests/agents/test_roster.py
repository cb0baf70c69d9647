"""What a heuristic team knows of its own members."""

from __future__ import annotations

from dataclasses import replace

from adhoc.agents.roster import MemberState, Roster
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability

MATE = MemberState("mate", (1.0, 2.0), Capability(), busy="Cup_0", covered=((1, 2),))


def said(state: MemberState) -> Message:
    return replace(state.message(), sender=state.name, step=0)


def test_a_state_is_read_back():
    roster = Roster()
    assert roster.hear(1, [said(MATE)]) == (MATE,)
    assert list(roster.handled()) == ["Cup_0"]
    assert roster.positions() == ((1.0, 2.0),)
    assert not roster.all_idle()


def test_a_member_that_falls_silent_holds_nobody_up():
    """Its battery is empty: it never says so any more, and its object is free for others."""
    roster = Roster(patience=3)
    roster.hear(1, [said(MATE)])
    roster.hear(4, [])
    assert list(roster.handled()) == ["Cup_0"]
    roster.hear(5, [])
    assert list(roster.handled()) == []
    assert roster.all_idle()
    assert roster.positions() == ()


def test_a_strangers_noise_is_no_state():
    roster = Roster()
    noise = [Message(MessageKind.TEAM, "", {"capability": 3}, None, "stranger", 0)]
    assert roster.hear(1, [*noise, replace(noise[0], payload={})]) == ()
    assert roster.all_idle()
