"""Scenarios, episodes, the referee, metrics, records, reports and pictures (paper, section Experiments)."""
