"""Tidying up: find every misplaced object and put it where it belongs (the paper's task)."""

from adhoc.tasks.tidying_up.task import TidyingUp

__all__ = ["TidyingUp"]
