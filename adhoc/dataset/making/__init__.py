"""Making a split of a dataset: houses, tasks in them, and what the oracle says of these."""
