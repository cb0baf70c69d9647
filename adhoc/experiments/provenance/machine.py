"""The machine on which a session of a run took place."""

from __future__ import annotations

import os
import platform
from pathlib import Path
from typing import Any

_CPU_FACTS = Path("/proc/cpuinfo")
_CPU_NAMES = ("model name", "Model", "Hardware")


def machine_facts() -> dict[str, Any]:
    """Host, system, processor and memory, as JSON values. What the system does not tell is None."""
    return {
        "host": platform.node(),
        "system": f"{platform.system()} {platform.release()}",
        "architecture": platform.machine(),
        "cpu": _cpu(),
        "cpus": os.cpu_count(),
        "cpus_usable": _usable(),
        "memory_bytes": _memory(),
    }


def _cpu() -> str | None:
    try:
        lines = _CPU_FACTS.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() in _CPU_NAMES and value.strip():
            return value.strip()
    return platform.processor() or None


def _usable() -> int | None:
    """How many of them this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None


def _memory() -> int | None:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None
