"""Tasks: goals with their vocabularies of sub-tasks and sub-skills, and common sense."""
