"""A deterministic stand-in for a language model: it reads the prompt and reasons by rule."""
