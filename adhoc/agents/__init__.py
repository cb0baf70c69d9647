"""Policies: the minds of robots, and what they share (memory, communication, assessment)."""
