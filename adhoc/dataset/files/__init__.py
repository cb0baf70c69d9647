"""The files of datasets: houses, tasks and ceilings, written and read with checksums."""
