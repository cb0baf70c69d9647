"""Derive the compact fact tables of `adhoc.houses.facts` from the databases of the procthor wheel.

    python scripts/make_facts.py procthor-0.0.1.dev2-py3-none-any.whl [--out adhoc/houses/facts_data]

The source is the wheel file, or the folder of an unpacked wheel. The same source gives the same bytes on
every machine. `NOTICE` says what is derived and from where.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import zipfile
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

DATABASES = "procthor/databases"
ROOM_COLUMNS = {
    "Kitchen": "inKitchens",
    "LivingRoom": "inLivingRooms",
    "Bedroom": "inBedrooms",
    "Bathroom": "inBathrooms",
}
EXTRA_PAIRS = (("TVStand", "Pen"), ("TVStand", "CD"))
"""Pairs that ProcTHOR houses show although the receptacle statistics lack them; they get the probability
of a pair that was counted once."""

DIGITS = 4
"""Sizes to a tenth of a millimetre, masses to a tenth of a gram."""
PROBABILITY_DIGITS = 6

ANCHORS = {"corner": "inCorner", "edge": "onEdge", "middle": "inMiddle"}
"""Where in a room things stand, and the source's column that says so."""
GROUP_ROOMS = {
    "Kitchen": "kitchens",
    "LivingRoom": "livingRooms",
    "Bedroom": "bedrooms",
    "Bathroom": "bathrooms",
}


def main(arguments: list[str] | None = None) -> int:
    """Write the fact files; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="the procthor wheel, or the folder of an unpacked one")
    parser.add_argument("--out", type=Path, default=Path(__file__).parents[1] / "adhoc/houses/facts_data")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    for name, text in fact_files(options.source).items():
        (options.out / name).write_text(text, encoding="utf-8", newline="\n")
        print(f"{options.out / name}: {len(text)} bytes")
    return 0


def fact_files(source: Path) -> dict[str, str]:
    """The text of every fact file, by file name."""
    assets = read_database(source, "asset-database.json")
    annotations = read_database(source, "placement-annotations.json")
    masses = observed_masses(read_database(source, "ai2thor-object-metadata.json"))
    statistics_of_receptacles = read_database(source, "receptacles.json")
    return {
        "assets.json": lines(asset_table(assets, masses)),
        "categories.json": lines(category_table(assets, annotations, masses)),
        "furniture.json": lines(furniture_table(assets, annotations)),
        "furniture_groups.json": lines(group_table(assets, read_groups(source))),
        "receptacles.json": lines(receptacle_table(statistics_of_receptacles)),
        "wall_holes.json": lines(wall_hole_table(read_database(source, "wall-holes.json"))),
    }


def read_groups(source: Path) -> dict[str, Any]:
    """The JSON databases of the asset groups, by name."""
    if source.is_dir():
        paths = [path for root in (source, source.parent) for path in root.glob("**/asset_groups/*.json")]
        return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(paths)}
    with zipfile.ZipFile(source) as wheel:
        names = [name for name in sorted(wheel.namelist()) if Path(name).match("*/asset_groups/*.json")]
        return {Path(name).stem: json.loads(wheel.read(name)) for name in names}


def read_database(source: Path, name: str) -> Any:
    """One JSON database of the wheel."""
    if source.is_dir():
        roots = [source / DATABASES, source / "databases", source]
        path = next((root / name for root in roots if (root / name).is_file()), None)
        if path is None:
            sys.exit(f"{source}: no {name} there; give the procthor wheel or the folder it was unpacked to")
        return json.loads(path.read_text(encoding="utf-8"))
    with zipfile.ZipFile(source) as wheel:
        return json.loads(wheel.read(f"{DATABASES}/{name}"))


def observed_masses(metadata: dict[str, list[list[dict[str, Any]]]]) -> dict[str, dict[str, list[float]]]:
    """Masses in kilograms of every object seen in the scenes, by category and asset."""
    masses: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for scenes in metadata.values():
        for scene in scenes:
            for thing in scene:
                masses[thing["objectType"]][thing["assetId"]].append(thing["mass"])
    return masses


def category_mass(masses: dict[str, list[float]]) -> float:
    """The commonest positive mass of a category, 0 if it has none (things fixed to the house)."""
    counts = Counter(mass for values in masses.values() for mass in values if mass > 0)
    return round(min(counts, key=lambda mass: (-counts[mass], mass)), DIGITS) if counts else 0.0


def asset_table(assets: dict[str, Any], masses: dict[str, dict[str, list[float]]]) -> dict[str, Any]:
    """category -> asset -> [size x, size y, size z (up)], with the mass appended where it is special."""
    table: dict[str, Any] = {}
    for category in sorted(assets):
        usual = category_mass(masses.get(category, {}))
        rows = {}
        for asset in sorted(assets[category], key=lambda entry: entry["assetId"]):
            box = asset["boundingBox"]
            row = [round(box[axis], DIGITS) for axis in "xzy"]
            seen = masses.get(category, {}).get(asset["assetId"], [])
            own = round(statistics.median(seen), DIGITS) if seen else usual
            rows[asset["assetId"]] = [*row, own] if is_pickupable(assets, category) and own != usual else row
        table[category] = rows
    return table


def category_table(
    assets: dict[str, Any], annotations: dict[str, Any], masses: dict[str, dict[str, list[float]]]
) -> dict[str, Any]:
    """category -> pickupable, on_floor, mass, and weight per room type."""
    return {
        category: {
            "pickupable": is_pickupable(assets, category),
            "on_floor": bool(annotations["onFloor"].get(category)),
            "mass": category_mass(masses.get(category, {})),
            "rooms": {
                room_type: int(annotations[column].get(category) or 0)
                for room_type, column in ROOM_COLUMNS.items()
            },
        }
        for category in sorted(assets)
    }


def furniture_table(assets: dict[str, Any], annotations: dict[str, Any]) -> dict[str, Any]:
    """category -> where in a room it stands, whether a room may hold several, and whether it is fixed."""
    return {
        category: {
            "anchors": [name for name, column in ANCHORS.items() if annotations[column].get(category)],
            "multiple": bool(annotations["multiplePerRoom"].get(category)),
            "fixed": bool(annotations["isKinematic"].get(category)),
        }
        for category in sorted(assets)
    }


def group_table(assets: dict[str, Any], groups: dict[str, Any]) -> dict[str, Any]:
    """name of a furniture group -> rooms, anchors, and members, each after the member it belongs to."""
    return {
        name: {
            "rooms": {
                room: int(group["groupProperties"]["roomWeights"][column])
                for room, column in GROUP_ROOMS.items()
            },
            "anchors": [anchor for anchor in ANCHORS if group["groupProperties"]["location"][anchor]],
            "duplicates": bool(group["groupProperties"]["properties"]["allowDuplicates"]),
            "members": group_members(assets, group),
        }
        for name, group in sorted(groups.items())
    }


def group_members(assets: dict[str, Any], group: dict[str, Any]) -> list[dict[str, Any]]:
    """The members of a group in the frame of its first one: x to the right, y to the front, z up.

    A member's middle is its parent's middle, plus `side` times half the parent's extents, plus `offset`,
    plus `align` times half its own extents. `turn` is in degrees counter-clockwise, drawn from within
    `sway` degrees. The source's x axis is mirrored, as its own reader does, and its angles are clockwise.
    """
    members: list[dict[str, Any]] = []
    stack = [(tree, None) for tree in reversed(group["treeData"])]
    while stack:
        tree, parent = stack.pop()
        source = group["assetMetadata"][str(tree["instanceId"])]
        position = source["position"]
        stack += [(child, len(members)) for child in reversed(tree.get("children", ()))]
        row, column = divmod(int(position["relativeAnchorToParent"]), 3)
        placed = {
            "side": [1 - column, row - 1],
            "offset": [round(-position["x"], DIGITS) + 0.0, round(position["z"], DIGITS)],
            "align": [int(position["xAlignment"]) - 1, int(position["zAlignment"]) - 1],
        }
        members.append(
            {
                "name": source["name"],
                "assets": {
                    category: None if len(ids) == len(assets[category]) else sorted(ids)
                    for category, ids in sorted(source["assetIds"].items())
                },
                "parent": parent,
                "above": parent is not None and position["verticalAlignment"] == "above",
                **(placed if parent is not None else {}),
                "turn": int(-source["rotation"]) % 360,
                "sway": int(source["randomness"]["dtheta"]),
            }
        )
    return members


def is_pickupable(assets: dict[str, Any], category: str) -> bool:
    """Whether any asset of the category can be picked up (a few of them are marked static by mistake)."""
    return any(asset.get("primaryProperty") == "CanPickup" for asset in assets[category])


def receptacle_table(receptacles: dict[str, Any]) -> dict[str, Any]:
    """receptacle -> category -> probability that such a receptacle holds such an object."""
    table = {
        receptacle: {
            category: round(entry["p"], PROBABILITY_DIGITS) for category, entry in sorted(contents.items())
        }
        for receptacle, contents in sorted(receptacles.items())
    }
    for receptacle, category in EXTRA_PAIRS:
        once = min(entry["p"] / entry["count"] for entry in receptacles[receptacle].values())
        table[receptacle].setdefault(category, round(once, PROBABILITY_DIGITS))
        table[receptacle] = dict(sorted(table[receptacle].items()))
    return table


def wall_hole_table(holes: dict[str, Any]) -> dict[str, Any]:
    """door or window asset -> [width, height] of the hole that it needs in a wall."""
    return {
        asset: [round(hole["max"][axis] - hole["min"][axis], DIGITS) for axis in "xy"]
        for asset, hole in sorted(holes.items())
    }


def lines(table: dict[str, Any]) -> str:
    """JSON with one line per key of the table, so that changes can be read."""
    rows = (f"{json.dumps(key)}:{json.dumps(table[key], separators=(',', ':'))}" for key in table)
    return "{\n" + ",\n".join(rows) + "\n}\n"


if __name__ == "__main__":
    sys.exit(main())
