"""Maps over k and m2/m1, resumable, on threads or a cluster."""
