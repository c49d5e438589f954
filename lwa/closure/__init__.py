"""The consistency condition: slaved fields that satisfy the equations of motion."""
