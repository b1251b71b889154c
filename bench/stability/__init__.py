"""Stability, mapped: `python -m bench stability`. docs/STABILITY.md says how to read what it draws."""
