"""Étendue beside other path tracers, and beside the bare ray tracing of its own rays.

`python -m benchmarks --help` tells how to run it; docs/performance.md what it found.
"""
