"""Worlds: the contract of a simulated house with robots in it, and its PyBullet adapter."""
