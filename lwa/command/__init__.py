"""The command `lwa`: input at the door, and results as text, JSON, LaTeX and source."""
