"""From pixels to knowledge: semantic points, voxels, a top-down map, objects, rooms and a scene graph."""
