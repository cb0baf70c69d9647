"""Running a configuration that another Hydra application composed."""

from __future__ import annotations

from dataclasses import fields

from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from adhoc.cli.config_checks import check_config
from adhoc.cli.config_errors import one_line
from adhoc.cli.run_configs import run_configs
from adhoc.cli.schema import RunConfig
from adhoc.core.errors import ConfigurationError

KEYS = tuple(field.name for field in fields(RunConfig))


def run_config(config: DictConfig) -> int:
    """Run it as `adhoc run` would; returns the exit code, which is 1 if episodes failed.

    Keys that are the application's own are left alone. Raises AdhocError for whatever is wrong with others.
    """
    try:
        mine = {name: config[name] for name in KEYS if name in config}
        plain = OmegaConf.to_container(OmegaConf.create(mine), resolve=True)
        typed = OmegaConf.merge(OmegaConf.structured(RunConfig), plain)
    except OmegaConfBaseException as error:
        raise ConfigurationError(one_line(error)) from error
    assert isinstance(typed, DictConfig)
    check_config(typed)
    return run_configs([typed])
