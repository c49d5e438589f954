"""The compiled loops of the engine; `validation.lattice.engine` explains the method.

Loops over all beads hold no branch and read contiguous arrays, so that they vectorise. Only
`advance` and `interpolate` are called from outside; their cached machine code is tied to the text
of every file of this folder (`compiled.SOURCES`).
"""
