"""Hard cases, each held to a bound."""
