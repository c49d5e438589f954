"""The consistency condition: slaved fields that satisfy the equations of motion.

How to add a closure of your own:

1. Write a function in a module here that takes a `Model` and returns a `Solution`: the terms E_n of
   the wave equation and those of the fields, as polynomials of a `JetAlgebra` of the model.
   `ansatz.acoustic` is an example; `slaving.Force` expands the force of a contact.
2. Add its name to `lwa.base.words.ClosureName` and its call to `Closure.solution`, and refuse in
   `Closure.__post_init__` what the function does not cover.
3. Add a case to ``tests/lwa/closure/test_motion.py``, which puts the fields into every equation of
   motion of the chain.
"""
