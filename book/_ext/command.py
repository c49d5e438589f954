"""A command of the package, run by a fork of the process that has the package loaded.

It stands in the place of `lwa` and `lwa-validate` while the book is built, and passes its arguments
and standard streams to `loaded.py`: to load the packages for each command takes more CPU than most
commands.
"""

import json
import os
import socket
import sys

path, name, *arguments = sys.argv[1:]
connection = socket.socket(socket.AF_UNIX)
connection.connect(path)
request = json.dumps([name, arguments, os.getcwd(), dict(os.environ)])
socket.send_fds(connection, [request.encode()], [0, 1, 2])
# Nothing comes from a process that failed without a status.
(status,) = connection.recv(1) or [1]
sys.exit(status)
