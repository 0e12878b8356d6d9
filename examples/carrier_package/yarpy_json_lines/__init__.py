"""A carrier, a transport and a name service for yarpy, as a package of its own."""
