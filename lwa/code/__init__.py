"""A wave as functions in a program: what they compute, and the languages."""
