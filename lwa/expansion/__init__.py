"""The expansion of a chain's traveling wave in ε = k - 1, exact at every order, and its sums."""
