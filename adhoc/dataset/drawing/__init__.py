"""Pictures of houses and tasks."""
