"""Results of studies: tables, findings, pictures, and commands that print them."""
