"""Generating houses of our own in ProcTHOR's format and after its statistics."""
