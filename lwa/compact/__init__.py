"""A compact wave in numbers: its curves, in physical units, in arrays, in pictures."""
