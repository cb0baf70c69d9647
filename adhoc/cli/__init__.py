"""The command line: `adhoc run`, `adhoc report` and `adhoc house`."""
