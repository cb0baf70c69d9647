"""Whether a run folder holds what it should, and whether every number in it follows from the records."""
