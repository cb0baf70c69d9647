"""The controllers of the sub-skills: from one sub-skill to low-level actions, one a step."""
