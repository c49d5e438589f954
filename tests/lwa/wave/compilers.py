"""Generated code as functions that Python calls: C compiled, JavaScript in Node.js."""

import ctypes
import json
import subprocess
from functools import partial

from lwa.wave.source import Function

PROGRAMS = {"c": "cc", "javascript": "node"}
"""Programs that run or compile the generated languages."""

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-shared", "-fPIC")


def compiled(source, functions: list[Function], folder):
    """Name → the compiled function of numbers."""
    file, library = folder / "lwa_wave.c", folder / "lwa_wave.so"
    file.write_text(source + "\n", encoding="utf-8")
    command = ["cc", *STRICT, "-o", library, file, "-lm"]
    subprocess.run(command, check=True, cwd=folder, timeout=120)
    loaded = ctypes.CDLL(str(library))
    found = {}
    for function in functions:
        found[function.name] = call = getattr(loaded, function.name)
        call.restype = ctypes.c_double
        call.argtypes = [ctypes.c_double] * len(function.arguments)
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
