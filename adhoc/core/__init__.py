"""Values, errors, geometry and random streams: what every other package speaks in."""
