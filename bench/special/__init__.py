"""Special cases, measured: `python -m bench special`.

What `area` and `auto` promise of crossings, ends, corners and scattered scratches: how right, how fast, how they scale.
"""
