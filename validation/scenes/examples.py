"""Scenes to begin with, as files in TOML; `validation.scenes.scenefile` says what they may hold."""

_STEEL = """\
[materials]                   # Young's modulus in Pa, Poisson's ratio
steel = {E = 193e9, nu = 0.3}
"""
_PTFE = """\
ptfe = {E = 1.46e9, nu = 0.46}
"""
_BEADS = """
[beads]                       # in kg and m
steel = {mass = 0.45e-3, radius = 2.38e-3, material = "steel"}
"""
_LIGHT = """\
ptfe = {mass = 0.123e-3, radius = 2.38e-3, material = "ptfe"}
"""
_WALL = """
[wall]                        # behind the last bead
material = "steel"
"""
_STRIKER = """
[striker]                     # bead 1
velocity = 1.37               # m/s
"""
_BOTH = _STEEL + _PTFE + _BEADS + _LIGHT

EXAMPLES = {
    "paper": ("1:1 chain of steel and PTFE, as in Porter et al. (2008)", f"""\
duration = 1.2e-3             # s

{_BOTH}
[chain]
cell = ["steel", "ptfe"]
repeat = 19
{_WALL}{_STRIKER}
[sensors]                     # counted from 1; or "all"
beads = [15, 34]
"""),
    "vertical": ("steel beads under their own weight", f"""\
duration = 0.3e-3             # s
gravity = 9.81                # m/s^2, towards the wall

{_STEEL}{_BEADS}
[chain]
cell = ["steel"]
repeat = 40
{_WALL}{_STRIKER}
[sensors]
contacts = [10, 20, 30]       # contact 10 joins beads 10 and 11
"""),
    "precompressed": ("steel beads pressed together, an x–t map of all contacts", f"""\
duration = 0.4e-3             # s
precompression = 20.0         # N, on bead 1 towards the wall

{_STEEL}{_BEADS}
[chain]
cell = ["steel"]
repeat = 40
{_WALL}
[striker]
velocity = 0.05               # m/s

[sensors]
contacts = "all"
"""),
    "defect": ("a light bead in a chain of steel", f"""\
duration = 0.5e-3             # s

{_STEEL}{_BEADS}
[chain]
cell = ["steel"]
repeat = 40

[[defects]]                   # one table for each
bead = 20
mass = 0.1e-3
{_STRIKER}
[sensors]
beads = [10, 20, 30]
"""),
    "trimer": ("2:1 chain, two beads of steel to one of PTFE", f"""\
duration = 1.2e-3             # s

{_BOTH}
[chain]
cell = ["steel", "steel", "ptfe"]
repeat = 14
{_STRIKER}
[sensors]
contacts = [12, 24, 36]
"""),
}  # fmt: skip
"""Name → what it is, and the file."""
