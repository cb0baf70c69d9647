"""Another Hydra application uses the groups of `adhoc run`."""

from __future__ import annotations

import json
import subprocess
import sys

APPLICATION = """
import json
import hydra
from adhoc import Components, register_groups

register_groups()

@hydra.main(version_base="1.3", config_path="conf", config_name="mine")
def main(config):
    newcomer = Components(config).newcomer
    print(json.dumps([config.temperature, config.team.name, newcomer.label, config.limit]))

main()
"""


def test_groups_are_chosen_beside_keys_of_its_own(tmp_path):
    (tmp_path / "conf" / "policy").mkdir(parents=True)
    mine = "defaults: [adhoc_run, _self_]\ntemperature: 3\nlimit: 1\nhydra: {run: {dir: .}}\n"
    (tmp_path / "conf" / "mine.yaml").write_text(mine)
    (tmp_path / "application.py").write_text(APPLICATION)
    command = [sys.executable, "application.py", "policy=gpl", "team=room_by_room", "temperature=4"]
    said = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=100
    ).stdout
    assert json.loads(said.splitlines()[-1]) == [4, "room_by_room", "GPL-LLM", 1]
