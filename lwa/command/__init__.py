"""The command `lwa`: options, and results as text, JSON, LaTeX and source code.

To add a quantity, append a `lwa.command.answer.Row` to the rows of its command: its key is the name
in JSON, its label the one in text with the unit in SI, its symbol the one in LaTeX. To add a
command, write a function with `lwa.command.options.command` and its options in a module of this
folder; the function takes the chain of the options and returns an `lwa.command.answer.Answer`. Name
module and summary in `lwa.command.cli.COMMANDS`, give it an example, and a line in the book's list
of commands, which a test compares with that table.
"""
