"""What is possible in a task: a central planner with full knowledge, for evaluation only."""

from adhoc.dataset.oracle.ceilings import Ceiling, Kind, ceiling
from adhoc.dataset.oracle.knowledge import Rules
from adhoc.dataset.oracle.summary import CeilingRow, summarise, to_markdown, to_table

__all__ = ["Ceiling", "CeilingRow", "Kind", "Rules", "ceiling", "summarise", "to_markdown", "to_table"]
