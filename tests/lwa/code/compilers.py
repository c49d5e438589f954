"""Generated code as functions that Python calls: C and Fortran compiled, JavaScript in Node.js."""

import ctypes
import json
import subprocess
from functools import partial

from lwa.code import Function

STRICT = ("-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-shared", "-fPIC")
COMMANDS = {
    "c": ("cc", "-std=c99", *STRICT),
    "fortran": ("gfortran", "-std=f2008", *STRICT),
}
PROGRAMS = {language: command[0] for language, command in COMMANDS.items()} | {"javascript": "node"}
"""Programs that run or compile the generated languages."""

SUFFIX = {"c": "c", "fortran": "f90"}


def compiled(source, language, functions: list[Function], folder):
    """Name → the compiled function of numbers.

    A Fortran function is called by a procedure that binds it to C.
    """
    command = COMMANDS[language]
    if language == "fortran":
        uses = ("use iso_c_binding", "use lwa_wave", "implicit none", "contains")
        bound = map(_bound, functions)
        source = "\n".join([source, "module called", *uses, *bound, "end module"])
    file, library = folder / f"lwa_wave.{SUFFIX[language]}", folder / f"lwa_wave_{language}.so"
    file.write_text(source + "\n", encoding="utf-8")
    subprocess.run([*command, "-o", library, file, "-lm"], check=True, cwd=folder, timeout=120)
    loaded = ctypes.CDLL(str(library))
    found = {}
    for function in functions:
        symbol = f"c_{function.name.lower()}" if language == "fortran" else function.name
        call = getattr(loaded, symbol)
        call.restype = ctypes.c_double
        call.argtypes = [ctypes.c_double] * len(function.arguments)
        found[function.name] = call
    return found


ANSWER = """
for await (const line of require("readline").createInterface({input: process.stdin})) {
  const [name, ...values] = JSON.parse(line);
  console.log(JSON.stringify(eval(name)(...values)));
}
"""


def in_node(source, functions: list[Function]):
    """Name → the function of numbers, called in a process of Node.js that ends with this one."""
    program = f"{source}\n(async () => {{{ANSWER}}})();"
    node = subprocess.Popen(
        ["node", "--eval", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )

    def call(name, *values):
        node.stdin.write(json.dumps([name, *map(float, values)]) + "\n")
        node.stdin.flush()
        return json.loads(node.stdout.readline())

    return node, {f.name: partial(call, f.name) for f in functions}


def _bound(function: Function) -> str:
    names = [f"x{i}" for i in range(len(function.arguments))]
    listed = ", &\n".join(names)
    return "\n".join(
        [
            f"function c_{function.name}({listed}) bind(C) result(y)",
            *(f"real(c_double), value :: {name}" for name in names),
            "real(c_double) :: y",
            f"y = {function.name}({listed})",
            "end function",
        ]
    )
