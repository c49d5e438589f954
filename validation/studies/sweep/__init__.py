"""Maps over k and m2/m1, resumable, on processes or a cluster."""
