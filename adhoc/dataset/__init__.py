"""The benchmark as data: houses, checks, task files, the oracle, and how generated houses compare."""
