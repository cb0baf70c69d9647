"""The README's planner stage, used from the command line without editing the library."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_the_stage_of_the_readme_runs_by_its_dotted_name(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert len(code.splitlines()) <= 20
    (tmp_path / "my_stages.py").write_text(code, encoding="utf-8")
    target = "policy.reflector._target_=my_stages.NearestRobotGoes"
    options = ["limit=1", "max_steps=15", "pictures=false", "out=mine", "benchmark=demo", target]
    command = [sys.executable, "-m", "adhoc.cli.main", "run", "policy=irot", *options]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    records = [json.loads(line) for line in (tmp_path / "mine" / "episodes.jsonl").read_text().splitlines()]
    assert {record["policy"] for record in records} == {"none", "irot"}
    transcript = next((tmp_path / "mine" / "transcripts").iterdir()).read_text()
    assert "is closer to" in transcript or "no teammate is closer" in transcript
