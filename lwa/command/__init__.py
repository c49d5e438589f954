"""The command `lwa`: options, and results as text, JSON, LaTeX and source code."""
