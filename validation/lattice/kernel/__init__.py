"""The compiled loops that integrate a chain; `validation.lattice.engine` explains the method.

Letters and words. y, v: displacements and velocities of the beads. δ: compression of a contact.
``p(x)``, x from 0 to 1: polynomial close to δ over one step. Kink: time at which a contact
opens or closes. Knot: end of a step, at which the motion of the watched beads is stored. Embedded
pair: the Runge–Kutta–Nyström pair of `validation.lattice.schemes`.

Loops over all beads hold no branch and read contiguous arrays, so that they vectorise. Python calls
`advance` and `interpolate` only; their cached machine code is tied to the text of every file of
this folder (`compiled.SOURCES`).
"""
