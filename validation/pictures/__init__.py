"""Pictures: curves and maps in panels, and the objects that draw themselves."""
