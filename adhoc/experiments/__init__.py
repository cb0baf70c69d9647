"""Many episodes: planned, run in one or several processes, recorded one by one, and resumed."""
