"""Source text of functions of real numbers in several programming languages."""
