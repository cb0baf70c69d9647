"""`adhoc sensitivity`: how the order of policies depends on the offline reasoner's error rates."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from adhoc.cli.hydra_run import run_with_hydra
from adhoc.core.errors import ConfigurationError
from adhoc.reporting.folders import read_folders
from adhoc.reporting.sensitivity import sensitivity, sensitivity_markdown, settings
from adhoc.reporting.sensitivity_drawing import draw_sensitivity

POLICIES = (
    "naive",
    "cot",
    "gpl",
    "irot",
    "irot_no_evaluation",
    "irot_no_reflection",
    "irot_no_evaluation_no_reflection",
    "no_subtask_planner",
)
"""All that plan with a model."""
MISTAKE_RATES = (0.0, 0.1, 0.3)
DEFAULTS = ("team=heuristic", "benchmark=sample", "join_step=0", "pictures=false", "transcript=false")
EPILOG = """\
The offline reasoner is no language model: this shows how the planners bear mistakes, not how good a model
is. Each rate of each kind of mistake is one run, the other kinds being at 0, in a folder of its own below
DIR; the same command again goes on where it stopped. At the end it writes DIR/sensitivity.png, .svg, .md.

  adhoc sensitivity --out out/sensitivity workers=2
  adhoc sensitivity --out out/sensitivity --rates 0,0.2 --policies irot,cot join_step=50 benchmark=demo
"""


def main(arguments: Sequence[str]) -> int:
    """Run all settings, and draw. Raises AdhocError for wrong input."""
    parser = argparse.ArgumentParser(
        prog="adhoc sensitivity",
        description="Success of the planners against how often the offline reasoner errs.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--out", required=True, type=Path, metavar="DIR", help="where runs and figure go")
    parser.add_argument("--rates", type=_rates, default=MISTAKE_RATES, help="0,0.1,0.3")
    parser.add_argument("--policies", default=",".join(POLICIES), help="all that plan with a model")
    parser.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help="as of `adhoc run`")
    options = parser.parse_args(list(arguments))
    _check_overrides(options.overrides)
    _check_policies(options.policies.split(","))
    records = {}
    for setting in settings(options.rates):
        folder = options.out / setting.folder
        sys.stdout.write(f"{folder}\n")
        fixed = [f"policy={options.policies}", f"out={folder}", *setting.overrides]
        run_with_hydra(["-m", *DEFAULTS, *options.overrides, *fixed])
        records[setting] = read_folders([folder])
    found = sensitivity(records)
    for ending in ("png", "svg"):
        draw_sensitivity(found, options.out / f"sensitivity.{ending}")
    text = sensitivity_markdown(found)
    (options.out / "sensitivity.md").write_text(text, encoding="utf-8")
    sys.stdout.write(f"\n{text}\n{options.out / 'sensitivity.png'}\n")
    return 0


def _check_overrides(overrides: Sequence[str]) -> None:
    ours = ("policy=", "out=", "llm=", *(f"llm.{kind}" for kind in ("forget_capability", "ignore_")))
    for override in overrides:
        if override.lstrip("+").startswith(ours):
            raise ConfigurationError(f"{override}: is varied here; use --policies, --out and --rates")


def _check_policies(policies: Sequence[str]) -> None:
    for policy in policies:
        if policy not in POLICIES:
            raise ConfigurationError(
                f"--policies {policy}: is none that plans with a model; choose from {', '.join(POLICIES)}"
            )


def _rates(text: str) -> tuple[float, ...]:
    try:
        rates = tuple(float(part) for part in text.split(","))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of numbers such as 0,0.1,0.3") from error
    if not all(0.0 <= rate <= 1.0 for rate in rates):
        raise argparse.ArgumentTypeError(f"{text}: rates are probabilities, from 0 to 1")
    return rates
