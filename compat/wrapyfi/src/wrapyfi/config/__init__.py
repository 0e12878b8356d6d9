"""Which class has which modes, from files."""
