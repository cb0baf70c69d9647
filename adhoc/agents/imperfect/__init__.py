"""Teammates that are mistaken about what they see, tell untruths, or say nothing."""
