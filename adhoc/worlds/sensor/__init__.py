"""The depth and instance camera: an exact box ray-caster, its frame cache, and the TinyRenderer reference."""
