"""Prompts: templates filled from a planning context, and replies read back into values."""
