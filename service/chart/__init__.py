"""`intaglio chart`: speed against accuracy, every method at several settings against the converged reference.

Read in this order: `settings` (what is rendered), `run` (the loop), `record` (what a setting leaves on disk), `measure`
(from pictures to errors), `compare` (equal error), `report` (chart.json), `draw` (chart.png, contact.png).
"""
