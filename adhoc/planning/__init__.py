"""Choosing sub-tasks and sub-skills with a language model (IRoT, its ablations, and baselines)."""
