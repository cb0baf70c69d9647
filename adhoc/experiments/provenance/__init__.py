"""What decided a run, written beside its records: configuration, code, data, machine, models with dates."""
