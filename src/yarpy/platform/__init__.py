"""What systems do differently: one file for each thing, with what each system has for it."""
