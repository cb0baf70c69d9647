"""The configuration groups of `adhoc run` for other Hydra applications."""

from __future__ import annotations

from hydra.core.config_store import ConfigStore
from omegaconf import DictConfig, OmegaConf

from adhoc.cli.schema import SCHEMA_NAME, RunConfig
from adhoc.core.resources import data_dir

RUN = "adhoc_run"
"""The name of the whole configuration, as `adhoc run` composes it."""
_OPEN_SCHEMA = "adhoc_schema"
_GLOBAL = "# @package _global_"


def register_groups() -> None:
    """Make `policy`, `team`, `benchmark` and all other groups known to Hydra, and the whole as `adhoc_run`.

    Call it before `hydra.main`. A configuration of yours that begins with

        defaults: [adhoc_run, _self_]

    has all keys of `adhoc run`, and may have others; `policy=irot team=llm` on your command line chooses
    among ours. `cli.contestants.Components` builds what it describes, `cli.hydra_application.run_config` runs
    it.
    Of one name, a file in your own configuration folder goes before ours.
    """
    store, root = ConfigStore.instance(), data_dir("configs")
    for path in sorted(root.rglob("*.yaml")):
        group = path.parent.relative_to(root).as_posix()
        text = path.read_text(encoding="utf-8")
        package = "_global_" if text.startswith(_GLOBAL) else None
        if group != ".":
            node = OmegaConf.create(text)
            store.store(group=group, name=path.stem, node=node, package=package, provider="adhoc")
    store.store(name=_OPEN_SCHEMA, node=_open_schema(), provider="adhoc")
    run = (root / "run.yaml").read_text(encoding="utf-8").replace(f"- {SCHEMA_NAME}\n", f"- {_OPEN_SCHEMA}\n")
    store.store(name=RUN, node=OmegaConf.create(run), provider="adhoc")


def _open_schema() -> DictConfig:
    """The schema's keys and defaults without its types, so that a configuration may add keys of its own."""
    plain = OmegaConf.to_container(OmegaConf.structured(RunConfig))
    return OmegaConf.create(plain if isinstance(plain, dict) else {})
