"""PLASTIC: which known type of team is this, and what did work beside that type."""
