"""Scripted team types with one habit each: explore only, nearest first, room by room."""
