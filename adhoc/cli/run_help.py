"""The text of `adhoc run --help`: usage, and every choice of every group."""

from __future__ import annotations

from pathlib import Path

from adhoc.core.resources import data_dir

GROUPS = ("policy", "team", "task", "world", "benchmark", "imperfections", "llm", "executor", "experiment")

USAGE = """\
usage: adhoc run [-m] [KEY=VALUE ...]

Runs the team alone and with the ad hoc robot in every scenario of a benchmark, and records each episode
once. The same command again goes on where it stopped.

  adhoc run policy=irot join_step=50 out=results
  adhoc run -m policy=none,heuristic,irot join_step=0,50,100 out=results
  adhoc run experiment=table1 benchmark=sample out=results
  adhoc report results

values:
  join_step=0      the step at which the ad hoc robot joins
  out=out          the run folder
  seed=0           other seeds give other scenarios of the same make, or other episodes of fixed tasks
  limit=N          only the first N scenarios
  max_steps=500    the step limit of an episode
  failed_share=from_joining  what a failure counts for the newcomer in #AS: from_joining, or full
  dry_run=true     estimate calls, tokens and cost from a few episodes; ask no model and record nothing
  budget.run.usd=5 stop before more is spent in this run folder; also calls, tokens, and budget.episode
  ledger.mode=replay ledger.path=DIR  take every answer from the ledger of another run
  workers=1        processes that run episodes; they share one model, one ledger and one limit on calls
  shard=1/1        i/n runs the i-th of n parts in a folder of its own; adhoc merge puts them together
  fail_on_error=0.1  stop when more episodes failed: a share below 1, a number of them, or null for never
  pictures=true    draw every episode from above
  transcript=true  write one decision of every episode as a page to read

choices:
{choices}
parts of a choice, e.g. policy/evaluator=keep_order:
{parts}
The settings in the files are keys: world.image_size=64, policy.generator.n=5; any other parameter of a
component's class takes a plus: +world.robot_radius=0.3. Hydra's own options (--cfg job shows every key,
--config-dir DIR is for files of your own) work as usual.
"""


def help_text() -> str:
    """The help, with the configuration files that are in force."""
    root = data_dir("configs")
    parts = sorted(folder for group in GROUPS for folder in (root / group).iterdir() if folder.is_dir())
    return USAGE.format(
        choices="".join(_line(group, root / group) for group in GROUPS),
        parts="".join(_line(str(folder.relative_to(root)), folder) for folder in parts),
    )


def options(folder: Path) -> list[str]:
    """The names of the configuration files in a group's folder."""
    return sorted(path.stem for path in folder.glob("*.yaml"))


def _line(group: str, folder: Path) -> str:
    return f"  {group + '=':<26} {', '.join(options(folder))}\n"
