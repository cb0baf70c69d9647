"""Whether houses are sound: free cells, sight, penetration, gravity."""
