"""Ground of the package: exact input, frozen values, tables, files, progress, LaTeX."""
