"""A person who plays one robot, at the terminal or from a script."""
