"""How generated houses compare with real ones."""
