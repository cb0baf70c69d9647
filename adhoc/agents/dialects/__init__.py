"""Dialects: how a team speaks to the world, and how a stranger understands it."""
